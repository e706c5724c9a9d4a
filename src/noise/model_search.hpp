#pragma once
// Which sum of processes: a stepwise search. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// The sum that the options state, or all that a stepwise search tried, in its order: first on extracts of a long record, then
/// from the best of them on with all samples (refinement.hpp).
[[nodiscard]] std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                                    const CalibrationOptions& options);

[[nodiscard]] std::vector<const Estimable*> processes_of(const SumModel& model);
/// The next larger sums: one more process, a drift, or an autoregression one order higher in the place of white noise.
[[nodiscard]] std::vector<SumModel> larger(const SumModel& model, const CalibrationOptions& options);
/// The next smaller sums.
[[nodiscard]] std::vector<SumModel> smaller(const SumModel& model);
/// The process that stands for the sensor's own noise: white, or its autoregression; null where there is none.
[[nodiscard]] const SumModel::Term* base_of(const SumModel& model);

}  // namespace coast::noise
