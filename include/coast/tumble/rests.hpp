#pragma once
// Periods of rest in the recording of an IMU that is put down in many poses by hand.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "coast/record/imu.hpp"

namespace coast::tumble {

/// The IMU at rest in one pose: samples [first, last], and their means.
struct Rest {
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
  double from = 0.0;     ///< s from the start of the first interval
  double to = 0.0;
  Eigen::Vector3d gyro;           ///< mean rate, rad/s, sensor axes
  Eigen::Vector3d accel;          ///< mean specific force, m/s^2
  Eigen::Vector3d gyro_variance;  ///< of the mean, from the scatter of quarter-second means
  Eigen::Vector3d accel_variance;
  [[nodiscard]] double length() const { return to - from; }
};

/// Rests of at least `min_duration` seconds, in order. A quarter of a second is quiet if neither the scatter of its samples nor
/// the change of its mean from that of the quarters beside it exceeds several times that of the quietest tenth of the
/// recording. Values are compared with themselves only: bias, scale and unit do not matter.
/// @throws InputError  fewer than two seconds of samples
[[nodiscard]] std::vector<Rest> find_rests(const record::ImuRecording& sensor, double min_duration = 1.5);

}  // namespace coast::tumble
