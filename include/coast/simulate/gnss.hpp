#pragma once
// GNSS fixes of an antenna on a moving body.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/gnss.hpp"
#include "coast/simulate/trajectory.hpp"

namespace coast::simulate {

/// A period of the mission, seconds since its start: start <= t < start + duration.
struct Interval {
  double start = 0.0;
  double duration = 0.0;
  [[nodiscard]] bool contains(double t) const { return t >= start && t < start + duration; }
};

/// A period of degraded GNSS.
struct DegradedGnss {
  Interval when;
  record::FixQuality quality = record::FixQuality::kFloat;
  double sd_factor = 1.0;         ///< on the errors, white and correlated
  double stated_sd_factor = 1.0;  ///< on the stated sigmas; 1 with a large sd_factor: a wrong fix
};

/// All vectors are north, east, down; sd 0 is an error-free component (its stated sigma must not be 0).
struct GnssOptions {
  double rate_hz = 1.0;                                    ///< [0.001, 1000]
  double phase = 0.0;                                      ///< s from the start of the mission to the first fix, >= 0
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();   ///< from the body's point to the antenna, m
  Eigen::Vector3d sd = Eigen::Vector3d(0.01, 0.01, 0.02);  ///< white noise of a position, m
  struct Correlated {
    Eigen::Vector3d sd = Eigen::Vector3d::Zero();  ///< stationary, m
    double correlation_time = 60.0;                ///< s, > 0
  };
  std::optional<Correlated> correlated;        ///< Gauss-Markov error on top of the white one
  std::optional<Eigen::Vector3d> stated_sd;    ///< m; if absent, white and correlated together
  std::optional<Eigen::Vector3d> velocity_sd;  ///< white noise of a velocity, m/s; if absent, no velocities
  double time_offset = 0.0;                    ///< s: a fix tagged t is valid at t - time_offset
  std::vector<Interval> gaps;                  ///< no fixes at all
  std::vector<DegradedGnss> degraded;          ///< the first that contains the fix applies
};

/// Fixes at start + phase + k / rate, as long as the motion lasts.
///
///     r_ea_e = truth + C_n_e (white + correlated),   correlated[k+1] = exp(-dt/T) correlated[k] + w[k], stationary
///
/// A gap removes fixes without changing the others: errors are drawn for every epoch.
/// @throws std::invalid_argument  rate, phase, a negative sd, a stated sd that is not positive, a correlation time not positive
[[nodiscard]] record::GnssRecording gnss_fixes(const AnalyticTrajectory& motion, geo::GpsTime start, const GnssOptions& options,
                                               std::uint64_t seed);

}  // namespace coast::simulate
