#pragma once
// GNSS and IMU noise that make the innovations as likely as possible.

#include <functional>
#include <string>
#include <vector>

#include "coast/estimate/forward_filter.hpp"

namespace coast::estimate {

/// What multiplies or adds to the stated noise. The neutral value changes nothing.
struct NoiseAdjustment {
  GnssScale gnss_scale;
  CorrelatedGnss correlated_gnss;
  double gyro_factor = 1.0;   ///< on the gyro's white-noise density (standard deviation)
  double accel_factor = 1.0;  ///< on the accelerometer's
};

/// Which parts are free.
struct NoiseFitChoice {
  bool gnss_scale = true;
  bool correlated_gnss = true;
  bool imu_white_noise = false;
  bool to_the_optimum = true;  ///< false: a first look, to a tenth of a sigma, without deviations and a second round
};

/// Where a parameter ended: between its bounds, or on one. On the lower one of an amplitude, or of a factor on GNSS sigmas
/// beside a correlated error, the innovations ask for none of it.
enum class Bound { kNone, kLower, kUpper };

struct NoiseFit {
  NoiseAdjustment adjustment;
  double log_likelihood_before = 0.0;  ///< with the stated noise
  double log_likelihood_after = 0.0;
  std::size_t innovations = 0;  ///< position and velocity innovations that entered
  int evaluations = 0;          ///< passes of the filter
  /// Standard deviations of the logarithms of the free parameters, in the order of `names`: by the second derivatives at the
  /// optimum, each with all others free; infinite where the innovations do not tell it.
  std::vector<std::string> names;
  std::vector<double> log_sd;
  std::vector<Bound> bounds;  ///< in the same order
  /// By how much the log-likelihood falls where one of them is as stated (an amplitude: none) and the others are as they are.
  std::vector<double> needed;
};

[[nodiscard]] noise::ImuErrorModel adjusted(const noise::ImuErrorModel& model, const NoiseAdjustment& adjustment);
[[nodiscard]] FilterOptions adjusted(const FilterOptions& options, const NoiseAdjustment& adjustment);

/// Where a first search begins: the noise of `options`, with a small correlated error where that is free and none is stated.
[[nodiscard]] NoiseAdjustment starting_point(const FilterOptions& options, const NoiseFitChoice& choice);

/// Maximum likelihood of the innovations (prediction-error decomposition; Harvey 1989, section 3.4) over the logarithms of the
/// free parameters, by Newton's steps with exact scores: each is a pass of the filter and one backward over its knots. The gate
/// is open while fitting: what the final filter then refuses is left out and the fit repeated once.
/// @param from   where the search begins; what is not free keeps its value
/// @param start  state at the first epoch, covariance from ForwardFilter::initial_state
/// @throws NumericalError  the filter fails at the start values
[[nodiscard]] NoiseFit fit_noise(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options,
                                 const NoiseFitChoice& choice, const NoiseAdjustment& from,
                                 const std::function<FilterState(const ForwardFilter&)>& start,
                                 const std::function<void(double)>& progress = {});

}  // namespace coast::estimate
