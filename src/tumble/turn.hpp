#pragma once
// The rotation between two rests as the gyros measured it.

#include <Eigen/Core>
#include <cstddef>

#include "coast/record/imu.hpp"

namespace coast::tumble {

/// Errors of the gyros at which a turn is linearised.
struct GyroErrors {
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  Eigen::Vector3d bias_before;  ///< at the rest before, rad/s; linear in between
  Eigen::Vector3d bias_after;
};

/// C takes the axes after the turn to those before it. An error psi of it, C(1 + d) = (I + [psi x]) C, depends on the gain and
/// on the two biases as told by the partial derivatives.
struct Turn {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 9> by_gain = Eigen::Matrix<double, 3, 9>::Zero();  ///< xx, xy, xz, yx, ..., zz
  Eigen::Matrix3d by_bias_before = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_bias_after = Eigen::Matrix3d::Zero();
  double duration = 0.0;
  double turned = 0.0;  ///< rad
  bool whole = true;    ///< no sample is missing
};

/// Samples [first, last] of a recording. The rate of the Earth is taken out along the way.
/// @param earth_rate  in the axes before the turn, rad/s; zero where it is not known
[[nodiscard]] Turn integrate(const record::ImuRecording& sensor, std::size_t first, std::size_t last, const GyroErrors& errors,
                             const Eigen::Vector3d& earth_rate);

}  // namespace coast::tumble
