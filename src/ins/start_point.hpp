#pragma once
// Position and velocity at an instant from the fixes behind it, with the motion between them as the IMU felt it.

#include <Eigen/Core>

#include "coast/ins/alignment.hpp"
#include "gnss_track.hpp"

namespace coast::ins {

/// The attitude at the start of sample `at`, as found.
struct StartAttitude {
  std::size_t at = 0;
  Eigen::Matrix3d C_b_e;
  Eigen::Vector3d gyro_bias;
  Eigen::Vector3d accel_bias;
  double force_error = 0.0;  ///< m/s^2, what attitude, bias and vibration leave of the specific force over a second
};

/// Runs the strapdown over the first seconds and fits the fixes' residuals by an offset and a slope: no assumption about the
/// motion, however few the fixes. The body's point, in e.
[[nodiscard]] TrackPoint start_point(const AlignmentInput& input, const StartAttitude& attitude);

}  // namespace coast::ins
