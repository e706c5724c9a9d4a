#pragma once
// Attitude from motion: the specific force of the IMU, rotated by the gyro, compared with that from GNSS.

#include <Eigen/Core>
#include <optional>

#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"

namespace coast::ins {

/// Samples first..last (inclusive) and the priors of the sensor.
struct MatchInput {
  const record::ImuRecording& imu;
  const record::GnssRecording& gnss;
  std::size_t first = 0;
  std::size_t last = 0;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();         ///< prior, rad/s
  double gyro_bias_sd = 0.0;                                   ///< rad/s, > 0
  Eigen::Vector3d nearby_gyro_bias = Eigen::Vector3d::Zero();  ///< rad/s, start of the iteration
  double accel_bias_sd = 0.0;                                  ///< m/s^2, > 0
  bool vehicle_forward = false;                                ///< the body's x axis points along the velocity, to `kSideslip`
};

struct MatchResult {
  Eigen::Matrix3d C_b_e;             ///< at the start of sample `first`
  Eigen::Matrix3d psi_covariance_e;  ///< of psi_e, rad^2, scaled by the residuals
  Eigen::Vector3d gyro_bias;         ///< rad/s
  Eigen::Vector3d accel_bias;        ///< m/s^2; valid with C_b_e, which it compensates; alone it may be far off
  double gyro_bias_sd = 0.0;         ///< rad/s, root mean square of the axes
  double residual_sd = 0.0;          ///< m/s^2, of a mean specific force
  double horizontal_force = 0.0;     ///< m/s^2, root mean square over the window
  std::size_t observations = 0;
  double lead = 0.0;  ///< -2 log likelihood of the next best heading minus that of this one
};

/// Second differences of the antenna's position (or first ones of its velocity, where these are less noisy) are exact weighted
/// means of acceleration: hat (box) weights over the interval. The same means of the IMU's specific force, rotated to one
/// inertial frame by the gyro, differ from them by one rotation: Wahba's problem for a first value, then Gauss-Newton over the
/// attitude and both biases (with priors) from four headings, with weights from the residuals.
///
/// Optimisation-based alignment: Wu and Pan (2013), Velocity/position integration formula, IEEE Trans. AES 49; there without
/// biases.
/// @return none if there are fewer than four observations
[[nodiscard]] std::optional<MatchResult> match_specific_force(const MatchInput& input);

}  // namespace coast::ins
