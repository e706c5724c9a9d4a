#pragma once
// Which sum of processes: all candidates fitted and scored. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// Fits one sum: start from the Allan curve and from what smaller sums found, then maximum likelihood.
/// @param starts  further start values of u
[[nodiscard]] Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                                      const std::vector<std::vector<double>>& starts);

/// Every sum of the options, smaller ones first. @return in the order of the table
[[nodiscard]] std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                                    const CalibrationOptions& options);

/// Index of the best by the criterion; degenerate ones stand behind.
[[nodiscard]] std::size_t choose(const std::vector<Candidate>& candidates, Criterion criterion);

}  // namespace coast::noise
