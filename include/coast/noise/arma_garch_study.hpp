#pragma once
// Coverage of the robust intervals of an ARMA-GARCH estimate, from many simulated series of a known model.

#include <functional>

#include "coast/noise/arma_garch.hpp"

namespace coast::noise {

struct ArmaGarchParameterSummary {
  std::string name;
  double truth = 0.0;
  double bias = 0.0;     ///< mean of estimate - truth
  double sd = 0.0;       ///< of the estimates
  double mean_se = 0.0;  ///< mean of the stated robust standard deviations
  std::size_t inside = 0;
  double coverage = 0.0;  ///< share of the 95 % intervals that contain the truth
};

struct ArmaGarchStudy {
  std::vector<ArmaGarchParameterSummary> parameters;
  double pooled_coverage = 0.0;  ///< over all parameters and runs
  std::size_t runs = 0;
  std::size_t without_uncertainty = 0;  ///< runs whose Hessian was not definite: counted as not containing the truth
  std::size_t not_converged = 0;
  double median_seconds = 0.0;  ///< of estimate and uncertainty, one series; the only figure that differs between two calls
};

/// Draws and estimates `runs` series of n samples, in parallel; the result is bitwise the same for any number of threads,
/// except for times.
/// @param first_seed  series r is drawn with first_seed + r
/// @param progress    called with the fraction done, from any thread
/// @param constant    nu is estimated too
/// @throws std::invalid_argument  no runs, a model with a defect, or too few samples to fit it
[[nodiscard]] ArmaGarchStudy run_arma_garch_study(const ArmaGarch& model, std::size_t n, std::size_t runs,
                                                  std::uint64_t first_seed, const std::function<void(double)>& progress = {},
                                                  bool constant = true);

}  // namespace coast::noise
