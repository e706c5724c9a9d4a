#pragma once
// The GNSS antenna's motion near an instant, from the surrounding fixes.

#include <Eigen/Core>

#include "coast/geo/time.hpp"
#include "coast/record/gnss.hpp"

namespace coast::ins {

/// Position and velocity of the antenna in e with standard deviations (one axis, root mean square of the three).
struct TrackPoint {
  Eigen::Vector3d r_ea_e;
  Eigen::Vector3d v_ea_e;
  double sd_position = 0.0;  ///< m
  double sd_velocity = 0.0;  ///< m/s
};

/// Parabola through the fixes within half a second of t, more until there are five; velocities, if the fixes have them, by
/// a line. @pre at least three fixes
[[nodiscard]] TrackPoint track_point(const record::GnssRecording& gnss, geo::GpsTime t);

/// Median time between adjacent fixes, s; zero if there are fewer than two.
[[nodiscard]] double typical_interval(const record::GnssRecording& gnss);

/// sqrt(trace / 3): the standard deviation of one axis.
[[nodiscard]] double axis_sd(const Eigen::Matrix3d& covariance);

/// Velocity of a fix resolved in e.  @pre it has one
[[nodiscard]] Eigen::Vector3d velocity_e(const record::GnssFix& fix);

}  // namespace coast::ins
