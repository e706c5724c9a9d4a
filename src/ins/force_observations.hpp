#pragma once
// Specific force from GNSS: means over spans of seconds, from differences of the antenna's positions or velocities.

#include <Eigen/Core>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/gnss.hpp"

namespace coast::ins {

/// A mean specific force of the antenna over [t_a, t_b] with hat weights (peak at t_k) or box weights.
struct ForceObservation {
  double t_a = 0.0, t_k = 0.0, t_b = 0.0;  ///< s since the reference
  bool hat = true;
  Eigen::Vector3d force_i;     ///< m/s^2, in the e-frame axes of the reference time (inertial)
  double variance = 0.0;       ///< (m/s^2)^2, one axis, from GNSS alone
  Eigen::Vector3d velocity_i;  ///< m/s, relative to the Earth, mean over the interval: the course
  double velocity_sd = 0.0;    ///< m/s, one axis
};

/// Hat means from second differences of position, or box means from differences of velocity, whichever have less noise, over
/// spans of 1 to 10 s, as long as required for 0.05 m/s^2, or from fix to fix if these are farther apart. Exact for any
/// motion within the span. In time order; none across gaps.
/// @param reference  origin of the observations' times; fixes from there to `end` are used
[[nodiscard]] std::vector<ForceObservation> observe_specific_force(const record::GnssRecording& gnss, geo::GpsTime reference,
                                                                   geo::GpsTime end);

}  // namespace coast::ins
