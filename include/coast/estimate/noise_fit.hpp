#pragma once
// Maximum-likelihood fit of GNSS and IMU noise to the innovations.

#include <functional>
#include <string>
#include <vector>

#include "coast/estimate/forward_filter.hpp"

namespace coast::estimate {

/// Factors on and additions to the stated noise. The default values change nothing.
struct NoiseAdjustment {
  GnssScale gnss_scale;
  CorrelatedGnss correlated_gnss;
  Eigen::Vector3d gyro_factors = Eigen::Vector3d::Ones();   ///< on the gyros' white-noise densities (standard deviation)
  Eigen::Vector3d accel_factors = Eigen::Vector3d::Ones();  ///< on the accelerometers'
};

/// How far a fit goes. Its cost with twelve parameters: about 10, 25 to 45, 80 and more passes of the filter.
enum class FitPrecision {
  kPreliminary,  ///< to a tenth of a sigma, without log_sd and a second round
  kSearch,       ///< to a twentieth of a sigma: steps of a search that compares likelihoods of whole runs
  kOptimum,      ///< to a thousandth of a sigma
};

/// Which parts are free.
struct NoiseFitChoice {
  bool gnss_scale = true;
  bool correlated_gnss = true;
  bool imu_white_noise = false;
  FitPrecision precision = FitPrecision::kOptimum;
};

/// Whether a parameter ended on one of its bounds. On the lower bound of an amplitude, or of a factor on GNSS sigmas combined
/// with a correlated error, the innovations show no such noise.
enum class Bound { kNone, kLower, kUpper };

struct NoiseFit {
  NoiseAdjustment adjustment;
  double log_likelihood_before = 0.0;  ///< with the stated noise
  double log_likelihood_after = 0.0;
  std::size_t innovations = 0;  ///< position and velocity innovations used
  int evaluations = 0;          ///< passes of the filter
  /// Standard deviations of the logarithms of the free parameters, in the order of `names`: from the second derivatives at the
  /// optimum, each with all others free; infinite if the innovations do not determine it.
  std::vector<std::string> names;
  std::vector<double> log_sd;
  std::vector<Bound> bounds;  ///< in the same order
  /// Decrease of the log-likelihood if one parameter is reset to its stated value (an amplitude: to none) and the others are
  /// kept.
  std::vector<double> needed;
};

[[nodiscard]] noise::ImuErrorModel adjusted(const noise::ImuErrorModel& model, const NoiseAdjustment& adjustment);
[[nodiscard]] FilterOptions adjusted(const FilterOptions& options, const NoiseAdjustment& adjustment);

/// Start of a first search: the noise of `options`, with a small correlated error if that is free and none is stated.
[[nodiscard]] NoiseAdjustment starting_point(const FilterOptions& options, const NoiseFitChoice& choice);

/// Maximum likelihood of the innovations (prediction-error decomposition; Harvey 1989, section 3.4) over the logarithms of the
/// free parameters; with the prior that the factors of a triad's axes are alike to about a factor of two, since not every
/// motion shows the noise of every axis. By Newton steps with exact scores: each needs a filter pass and a backward pass over
/// its knots. The gate is disabled while fitting; measurements that the final filter then rejects are left out and the fit is
/// repeated once.
/// @param from   start of the search; parameters that are not free keep their value
/// @param start  state at the first epoch, covariance from ForwardFilter::initial_state
/// @throws NumericalError  the filter fails at the start values
[[nodiscard]] NoiseFit fit_noise(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options,
                                 const NoiseFitChoice& choice, const NoiseAdjustment& from,
                                 const std::function<FilterState(const ForwardFilter&)>& start,
                                 const std::function<void(double)>& progress = {});

}  // namespace coast::estimate
