#pragma once
// Which sum of processes: all candidates fitted and scored. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// Fits one sum: start from the Allan curve and from what other sums found, then maximum likelihood, of a long record on what
/// ShortLikelihood keeps of it.
/// @param starts  further start values of u
[[nodiscard]] Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                                      const std::vector<std::vector<double>>& starts);

/// The sum that the options state, or all that a stepwise search tried, in its order.
[[nodiscard]] std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                                    const CalibrationOptions& options);

/// By the criterion; a sum with a process that says nothing stands behind any other.
[[nodiscard]] bool better(const Candidate& a, const Candidate& b, Criterion criterion);

/// Index of the best.
[[nodiscard]] std::size_t choose(const std::vector<Candidate>& candidates, Criterion criterion);

}  // namespace coast::noise
