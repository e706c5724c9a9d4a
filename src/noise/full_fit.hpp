#pragma once
// Fits to all samples from starts near the optimum, and start values from other sums. Private to the room.

#include <vector>

#include "candidate.hpp"
#include "spectrum.hpp"

namespace coast::noise {

/// Processes shared with a fitted sum start at its parameters; the others with variances `below` the upper end of their ranges,
/// in logarithms, and rates at the middle of theirs.
[[nodiscard]] std::vector<double> shared_start(const SumModel& from, const std::vector<double>& fitted, const SumModel& model,
                                               const std::vector<Interval>& ranges, double below);

/// Fitted and scored by ShortLikelihood, by Gauss-Newton steps with the curvature of the spectrum, from the likeliest of some
/// starts: to 1e-4 of log-likelihood, enough for the choice.
[[nodiscard]] Candidate fit_on_extracts(const std::vector<StaticSignal>& records, const Spectrum& spectrum,
                                        const SumModel& model, const std::vector<std::vector<double>>& starts);

/// Fitted and scored on all samples by Gauss-Newton steps with the curvature of the spectrum, from a start found on extracts or
/// the spectrum.
[[nodiscard]] Candidate fit_on_all_samples(const std::vector<StaticSignal>& records, const Spectrum& spectrum,
                                           const SumModel& model, const std::vector<double>& start,
                                           const CalibrationOptions& options);

}  // namespace coast::noise
