#pragma once
// Axes of robotics and of cameras. Private to the room.

#include <Eigen/Core>

#include "coast/geo/earth.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::io {

/// North-east-down to east-north-up, and back.
[[nodiscard]] inline Eigen::Matrix3d exchanged_axes() {
  Eigen::Matrix3d C;
  C << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
  return C;
}

/// Forward-left-up to forward-right-down, and back.
[[nodiscard]] inline Eigen::Matrix3d forward_left_up() {
  return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
}

/// Right-down-forward, the axes of a camera that looks ahead, to forward-right-down.
[[nodiscard]] inline Eigen::Matrix3d right_down_forward() {
  Eigen::Matrix3d C;
  C << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  return C;
}

}  // namespace coast::io
