#pragma once
// Estimates C_b^k and r^k from the signals, if they are only roughly known.

#include <Eigen/Core>
#include <vector>

#include "coast/array/frames.hpp"

namespace coast::array {

struct MountingOptions {
  double rotation_sd = 0.1;     ///< rad, prior sd of the stated attitude of a sensor, each axis
  double position_sd_m = 0.05;  ///< prior sd of its stated position, each axis
  double block_s = 0.1;         ///< residuals are averaged over this, to reduce vibration and remaining lags
  int iterations = 4;
};

struct RefinedSensor {
  SensorFrame frame;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< C_refined = exp([rotation x]) C_stated, rad
  Eigen::Vector3d rotation_sd = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_sd_m = Eigen::Vector3d::Zero();
};

struct RefinedMounting {
  std::vector<RefinedSensor> sensors;
  /// Root mean square of the sensors about their mean, biases removed, with stated and with refined frames: rad/s, m/s^2.
  double rates_before = 0.0, rates_after = 0.0;
  double forces_before = 0.0, forces_after = 0.0;
};

/// Attitude and position of every sensor relative to the others. A rotation phi of sensor k, a shift dr of its position and its
/// biases appear in its residuals to the mean of all as
///
///     rates:            omega x phi + b_g                 (small angles; iterated to convergence) specific forces:  f x phi +
///     A dr + b_a,   A = [alpha x] + [omega x][omega x]
///
/// solved by weighted least squares with the stated values as prior. Errors common to all sensors are not observable: the mean
/// rotation and the mean position stay as stated.
/// @param sensor_axes  signals on one grid in each sensor's own axes, with at least 100 blocks
/// @throws std::invalid_argument  fewer than two sensors, frames that do not match, too short
[[nodiscard]] RefinedMounting refine_mounting(const Signals& sensor_axes, const std::vector<SensorFrame>& stated,
                                              const MountingOptions& options = {});

}  // namespace coast::array
