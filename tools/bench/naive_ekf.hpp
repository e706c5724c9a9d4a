#pragma once
// The peer of the benchmark: a loosely coupled error-state EKF as it is commonly written, with a dense 21 x 21 transition,
// F P F' and driving noise at every IMU sample, dynamic matrices throughout. It stands on Eigen and the Earth alone, shares no
// filter code with the library, and computes the same thing: error = estimate - truth in e, 9 navigation states, and bias and
// scale factor of each gyro and accelerometer axis as first-order Gauss-Markov processes.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "coast/geo/earth.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::bench {

/// The usual 21-state parameters; one correlation time for all sensor states.
struct NaiveModel {
  double angle_random_walk = 0.0;     ///< rad/sqrt(s)
  double velocity_random_walk = 0.0;  ///< m/s/sqrt(s)
  double gyro_bias_sd = 0.0;          ///< rad/s
  double accel_bias_sd = 0.0;         ///< m/s^2
  double gyro_scale_sd = 0.0;         ///< -
  double accel_scale_sd = 0.0;        ///< -
  double correlation_time = 3600.0;   ///< s
};

/// Standard deviations of the initial navigation errors, each axis.
struct NaiveStart {
  record::NavState nav;
  double position_sd = 1.0;   ///< m
  double velocity_sd = 0.1;   ///< m/s
  double attitude_sd = 0.01;  ///< rad
};

class NaiveEkf {
 public:
  static constexpr int kStates = 21;

  NaiveEkf(const NaiveModel& model, const NaiveStart& start, const Eigen::Vector3d& lever_arm_b);

  /// Strapdown and covariance over one sample.
  void propagate(const record::ImuSample& sample);
  /// Position of the antenna at the filter's time.
  void update(const record::GnssFix& fix);

  [[nodiscard]] const record::NavState& nav() const { return nav_; }
  [[nodiscard]] const Eigen::MatrixXd& P() const { return P_; }

 private:
  void strapdown(const Eigen::Vector3d& dtheta, const Eigen::Vector3d& dv, double dt);
  [[nodiscard]] Eigen::MatrixXd dynamics(const Eigen::Vector3d& omega_ib_b, const Eigen::Vector3d& f_ib_b) const;
  [[nodiscard]] Eigen::MatrixXd noise_input() const;
  void feed_back(const Eigen::VectorXd& dx);

  NaiveModel model_;
  Eigen::Vector3d lever_arm_b_;
  record::NavState nav_;
  Eigen::MatrixXd P_;
  Eigen::MatrixXd Q_c_;
  Eigen::Vector3d bias_g_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_a_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale_g_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale_a_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d previous_dtheta_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d previous_dv_ = Eigen::Vector3d::Zero();
};

}  // namespace coast::bench
