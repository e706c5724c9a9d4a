#pragma once
// A sum fitted by the likelihood of a spectrum: a search tries this before it uses the samples. Private to the room.

#include <span>
#include <vector>

#include "spectrum.hpp"

namespace coast::noise {

/// A sum to be tried, with start parameters or, after `climb`, as fitted to the spectrum.
struct SpectralStep {
  SumModel model;
  std::vector<double> u;
  double log_likelihood = 0.0;  ///< of the spectrum
  double cost = 0.0;            ///< criterion on the spectrum
};

[[nodiscard]] std::span<const double> values_of(const std::vector<double>& u, const SumModel::Term& term);

/// Start of a neighbour of a fitted sum: shared processes as they were fitted; an autoregression of one order more as the same
/// series; a process that is added, or replaces another, at the best point of a coarse grid.
[[nodiscard]] std::vector<double> step_from(const SpectralStep& now, const SumModel& model, const Spectrum& spectrum,
                                            const std::vector<Interval>& ranges);

/// Maximises the spectrum's likelihood from the step's parameters.
void climb(const Spectrum& spectrum, const std::vector<Interval>& box, SpectralStep& step);

}  // namespace coast::noise
