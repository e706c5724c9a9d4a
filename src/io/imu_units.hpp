#pragma once

#include "coast/config/node.hpp"

namespace coast::io {

/// Factors from a file's numbers to rad/s and m/s^2, or to rad and m/s.
struct ImuFactors {
  double gyro = 1.0;
  double accel = 1.0;
};
/// From `units: {gyro: .., accel: ..}` and `scale: {..}` of an IMU's map.  @throws InputError  an unknown unit
[[nodiscard]] ImuFactors imu_factors(const config::Node& imu, bool increments);

}  // namespace coast::io
