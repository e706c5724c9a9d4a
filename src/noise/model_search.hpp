#pragma once
// Stepwise search for the sum of processes. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// Of the work of a search: that on extracts. The rest is that of refine.
inline constexpr double kSearchShare = 0.25;

/// The sum stated in the options, or all that a stepwise search tried, in its order: first on extracts of a long record, then
/// from the best of them on all samples (refinement.hpp).
[[nodiscard]] std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                                    const CalibrationOptions& options);

[[nodiscard]] std::vector<const Estimable*> processes_of(const SumModel& model);
/// The next larger sums: one more process, a drift, or an autoregression one order higher in place of white noise.
[[nodiscard]] std::vector<SumModel> larger(const SumModel& model, const CalibrationOptions& options);
/// The next smaller sums.
[[nodiscard]] std::vector<SumModel> smaller(const SumModel& model);
/// Sums with one slow process replaced by another: Gauss-Markov, random walk, flicker.
[[nodiscard]] std::vector<SumModel> exchanged(const SumModel& model, const CalibrationOptions& options);
/// The process for the sensor's own noise: white, or its autoregression; null if there is none.
[[nodiscard]] const SumModel::Term* base_of(const SumModel& model);

}  // namespace coast::noise
