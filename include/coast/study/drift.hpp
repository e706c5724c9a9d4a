#pragma once
// Statistics of one solution over many outages.

#include <array>
#include <span>
#include <vector>

#include "coast/geo/units.hpp"
#include "coast/study/outage.hpp"

namespace coast::study {

enum class DriftMeasure { kNorth, kEast, kDown, kHorizontal };

/// Largest absolute error inside each outage, m, in their order.
[[nodiscard]] std::vector<double> drifts(std::span<const OutageResult> outages, DriftMeasure measure, bool smoothed);

/// Statistics of absolute errors, m.
struct Spread {
  double median = 0.0;
  double p68 = 0.0;
  double p95 = 0.0;
  double max = 0.0;
  double rms = 0.0;
};
/// @param absolute_errors  not empty
[[nodiscard]] Spread spread_of(const std::vector<double>& absolute_errors);

/// One solution, forward or smoothed, in outages of one duration.
struct Drift {
  Spread horizontal;                                                  ///< largest horizontal error of each outage
  std::array<Spread, 3> largest;                                      ///< N, E, D: largest absolute error
  std::array<Spread, 3> end;                                          ///< N, E, D: at the last epoch before the next used fix
  Eigen::Vector3d predicted_end_rms_m = Eigen::Vector3d::Zero();      ///< of the predicted sigma there
  Eigen::Vector3d predicted_largest_rms_m = Eigen::Vector3d::Zero();  ///< of the largest sigma inside the outage
  double inside_95 = 0.0;                                             ///< share of all errors, axis by axis, within 1.96 sigma
  std::optional<Spread> against_gnss;                                 ///< horizontal, relative to the withheld fixes
};
/// @param outages  not empty; with a smoothed solution if `smoothed`
[[nodiscard]] Drift drift_of(std::span<const OutageResult> outages, bool smoothed);

/// Ratio of the forward error at the end of an outage to the smoothed error in its middle, one sigma each, if everything is
/// known on both sides: 2^(2m - 1) for white noise integrated m times; m = 2 for accelerometers, m = 3 for gyros, through the
/// tilt.
inline constexpr double kSmoothingGainOfAccelNoise = 8.0;
inline constexpr double kSmoothingGainOfGyroNoise = 32.0;

/// Horizontal drift due to white gyro noise alone, per axis: lower limit if position, velocity, attitude and every other sensor
/// error are known at the start of a gap in level, unaccelerated motion.
///
///     sigma(T)^2 = Q g^2 integral over s of ((T - s)^2 / 2)^2 = Q g^2 T^5 / 20
///
/// @param gyro_density  Q, rad^2/s  @param duration_s  T, s  @return m
[[nodiscard]] double gyro_noise_drift(geo::Psd gyro_density, double duration_s);

}  // namespace coast::study
