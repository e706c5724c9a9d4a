#pragma once
// Unit conversions; the only place with a 3600 or a pi/180. All other code uses SI units and radians.

#include <numbers>
#include <string_view>
#include <vector>

namespace coast::geo {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;        ///< rad
inline constexpr double kArcMinute = kDegree / 60.0;  ///< rad
inline constexpr double kStandardGravity = 9.80665;   ///< m/s^2, CGPM 1901
inline constexpr double kMilliGal = 1e-5;             ///< m/s^2
inline constexpr double kHour = 3600.0;               ///< s

/// What a unit measures; two units convert only within one dimension.
enum class Dimension {
  kAngle,
  kAngularRate,
  kSpecificForce,
  kVelocity,
  kLength,
  kTime,
  kRatio,
  kAngularRateNoise,       ///< rad/s/sqrt(Hz), equal to rad/sqrt(s)
  kSpecificForceNoise,     ///< m/s^2/sqrt(Hz), equal to m/s/sqrt(s)
  kAngularRateVariance,    ///< (rad/s)^2
  kSpecificForceVariance,  ///< (m/s^2)^2
  kAngularRateWalk,        ///< rad/s/sqrt(s)
  kSpecificForceWalk,      ///< m/s^2/sqrt(s)
  kAngularRateRamp,        ///< rad/s^2
  kSpecificForceRamp,      ///< m/s^3
  kRatioPerKelvin,
  kAngularRatePerKelvin,
  kSpecificForcePerKelvin,
  kAngularRatePerForce,  ///< rad/s/(m/s^2)
  kPerForce,             ///< m/s^2 per (m/s^2)^2 = 1/(m/s^2)
};

struct Unit {
  std::string_view name;  ///< as data sheets write it, e.g. "deg/sqrt(h)"
  double to_si;           ///< value [name] * to_si = value [SI]
  Dimension dimension;
};

/// The table of FORMATS.md, in order.
[[nodiscard]] const std::vector<Unit>& units();
/// @throws std::invalid_argument the name is not in the table; the message names the nearest one
[[nodiscard]] const Unit& unit(std::string_view name);
/// @throws std::invalid_argument unknown name, or a unit of another dimension (the message lists those that fit)
[[nodiscard]] double to_si(double value, std::string_view name, Dimension dimension);

/// Continuous-time power spectral density, [unit]^2/Hz. It has its own type, so that it cannot be used as a covariance.
struct Psd {
  double value = 0.0;
};
/// Covariance (variance) over one step, [unit]^2.
struct Cov {
  double value = 0.0;
};
/// Variance of the integral of white noise over dt: q dt.
[[nodiscard]] constexpr Cov integrate(Psd q, double dt) {
  return {q.value * dt};
}
/// Density of white noise whose mean over one sample interval at `rate_hz` has this variance: R / rate.
[[nodiscard]] constexpr Psd density_of_samples(Cov per_sample, double rate_hz) {
  return {per_sample.value / rate_hz};
}

}  // namespace coast::geo
