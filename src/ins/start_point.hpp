#pragma once
// Position and velocity at an instant from later fixes, with the motion between from the IMU.

#include <Eigen/Core>

#include "coast/ins/alignment.hpp"
#include "gnss_track.hpp"

namespace coast::ins {

/// The estimated attitude at the start of sample `at`.
struct StartAttitude {
  std::size_t at = 0;
  Eigen::Matrix3d C_b_e;
  Eigen::Vector3d gyro_bias;
  Eigen::Vector3d accel_bias;
  double force_error = 0.0;  ///< m/s^2, error of the specific force over a second by attitude, bias and vibration
};

/// Runs the strapdown over the first seconds and fits the fixes' residuals by an offset and a slope: without assumption on the
/// motion, for any number of fixes. The body's point, in e.
[[nodiscard]] TrackPoint start_point(const AlignmentInput& input, const StartAttitude& attitude);

}  // namespace coast::ins
