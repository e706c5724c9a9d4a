#pragma once
// The error-state transition between knots, composed from IMU samples.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "coast/estimate/state_layout.hpp"

namespace coast::estimate {

/// Rows of the navigation states of a transition: 9 x (9 + sensor states); the other states move by their blocks.
using NavRows = Eigen::Matrix<double, kNav, Eigen::Dynamic, Eigen::RowMajor>;
using NavCov = Eigen::Matrix<double, kNav, kNav, Eigen::RowMajor>;

/// What one IMU sample contributes; the strapdown has it at hand.
struct SampleDynamics {
  double dt = 0.0;
  Eigen::Matrix3d C_b_e;     ///< at the middle of the interval (mean of both ends)
  Eigen::Vector3d dv_e;      ///< integral of C f, m/s
  Eigen::Vector3d dtheta_b;  ///< rotation over the interval, rad
  Eigen::Vector3d dv_b;      ///< specific-force increment in b, m/s
};

/// Composes the transition and the white-noise covariance of the 9 navigation errors
///
///     dr' = dv
///     dv' = -2 [omega_ie x] dv + G dr - [C f x] psi - C de_a        Groves (2013, 2nd ed.) eq. (14.49), e-frame
///     psi' = -[omega_ie x] psi - C de_g
///
/// (de_g, de_a: errors of the estimated sensor errors). Per sample only the sums of C dt, C f dt and their double integral are
/// kept; every `kSubstep` they are folded into the transition, with products to second order. What is left out, relative to the
/// entry over a second: 1e-5 of the navigation states; of the sensor columns 1e-4 where force or attitude change at 1.5 Hz,
/// beta kSubstep / 2 for states that the navigator holds over a fold, and the sensor errors themselves (1e-3 for 1000 ppm).
class TransitionAccumulator {
 public:
  static constexpr double kSubstep = 0.05;  ///< s
  /// Whether so much pending time is to be folded; sums of intervals round, so a little less will do.
  [[nodiscard]] static constexpr bool substep_due(double pending) { return pending >= kSubstep - 1e-6; }

  TransitionAccumulator(const StateLayout& layout, double earth_rate);

  void reset();
  /// White noise from here on, body axes, [(rad/s)^2/Hz], [(m/s^2)^2/Hz]; the layout's before.
  void set_white_noise(const Eigen::Matrix3d& gyro_density_b, const Eigen::Matrix3d& accel_density_b) {
    gyro_density_b_ = gyro_density_b;
    accel_density_b_ = accel_density_b;
  }
  void add(const SampleDynamics& sample);
  [[nodiscard]] bool substep_due() const { return substep_due(pending_); }
  /// Folds what is pending. @param gravity_gradient dg/dr at the position, 1/s^2
  void fold(const Eigen::Matrix3d& gravity_gradient);

  [[nodiscard]] const NavRows& Phi_n() const { return Phi_n_; }
  [[nodiscard]] const NavCov& Q_n() const { return Q_n_; }
  [[nodiscard]] double elapsed() const { return elapsed_; }

  /// P <- Phi P Phi' + Q over what has been folded since reset(), every block of states included. Driving noise of sensor
  /// states reaches the navigation states within the interval by the closed form for a response that grows like a power of
  /// time (Brown & Hwang); intervals must be short against the states' correlation times.
  void propagate_covariance(Eigen::MatrixXd& P);

 private:
  template <typename Rows>
  void advance(Rows& rows, const Eigen::Matrix3d& gravity_gradient) const;
  void add_sensor_columns();
  void add_driven_covariance(Eigen::MatrixXd& P) const;
  void add_white_noise();
  void clear_pending();

  const StateLayout& layout_;
  double earth_rate_;
  Eigen::Matrix3d gyro_density_b_, accel_density_b_;
  NavRows Phi_n_;
  NavCov Q_n_;
  int gyro_states_ = 0;
  Eigen::RowVectorXd output_;  ///< h Phi(elapsed) of every sensor state: what a unit of it at the knot does now
  Eigen::RowVectorXd middle_;  ///< the same in the middle of the fold
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> effect_;  ///< of every sensor state on its integral, over the fold
  BlockTransitions over_half_fold_;
  BlockTransitions over_interval_;
  double elapsed_ = 0.0;
  bool multiplicative_ = false;  ///< whether any sensor state multiplies a signal

  double pending_ = 0.0;
  Eigen::Vector3d sum_f_;                        ///< integral of C f
  Eigen::Vector3d double_f_;                     ///< its double integral
  Eigen::Matrix3d sum_C_;                        ///< integral of C
  std::array<Eigen::Matrix3d, 3> sum_C_dtheta_;  ///< sums of C dtheta_k, k = x, y, z of b
  std::array<Eigen::Matrix3d, 3> sum_C_dv_;
};

}  // namespace coast::estimate
