#pragma once
// The error-state transition between knots, composed from IMU samples.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "coast/estimate/state_layout.hpp"

namespace coast::estimate {

/// Rows of the navigation states of a transition: 9 x (9 + sensor states); the other states have their own block transitions.
using NavRows = Eigen::Matrix<double, kNav, Eigen::Dynamic, Eigen::RowMajor>;
using NavCov = Eigen::Matrix<double, kNav, kNav, Eigen::RowMajor>;

/// Covariance that the white noise of each axis adds to the navigation states over an interval: gyro x, y, z, accelerometer
/// x, y, z, axes of the sensor.
using AxisNoise = std::array<NavCov, 6>;

/// Contribution of one IMU sample, available from the strapdown.
struct SampleDynamics {
  double dt = 0.0;
  Eigen::Matrix3d C_b_e;     ///< at the middle of the interval (mean of both ends)
  Eigen::Vector3d dv_e;      ///< integral of C f, m/s
  Eigen::Vector3d dtheta_b;  ///< rotation over the interval, rad
  Eigen::Vector3d dv_b;      ///< specific-force increment in b, m/s

  /// For an assumed motion, which depends neither on tilt nor on sensor errors.
  void without_sensors() {
    dv_e.setZero();
    C_b_e.setZero();
  }
};

/// Sums over some samples that are propagated as one step of the navigation errors.
struct Fold {
  double h = 0.0;                                      ///< length, s
  Eigen::Vector3d sum_f = Eigen::Vector3d::Zero();     ///< integral of C f
  Eigen::Vector3d double_f = Eigen::Vector3d::Zero();  ///< its double integral

  void add(const SampleDynamics& sample) {
    double_f += sample.dt * (sum_f + 0.5 * sample.dv_e);
    sum_f += sample.dv_e;
    h += sample.dt;
  }
  /// rows <- transition of the navigation errors over the fold times rows (9 x any). @param G  dg/dr, 1/s^2
  template <typename Rows>
  void advance(Rows& rows, const Eigen::Matrix3d& G, double earth_rate) const;
  /// Effect of errors of the estimated sensor errors at the end of the fold. Gyro: full effect on attitude, half of the cross
  /// product with it on velocity, a sixth on position; accelerometer: full effect on velocity, half on position.
  /// @param effect  integral of C times the error over the fold, 3 x any  @param rows  9 x as many
  template <typename Rows, typename Effect>
  void add_gyro_errors(Rows&& rows, const Effect& effect) const;
  template <typename Rows, typename Effect>
  void add_accel_errors(Rows&& rows, const Effect& effect) const;
};

/// Composes the transition and the white-noise covariance of the 9 navigation errors
///
///     dr' = dv
///     dv' = -2 [omega_ie x] dv + G dr - [C f x] psi - C de_a        Groves (2013, 2nd ed.) eq. (14.49), e-frame
///     psi' = -[omega_ie x] psi - C de_g
///
/// (de_g, de_a: errors of the estimated sensor errors). Per sample only the sums of C dt, C f dt and their double integral are
/// kept; every `kSubstep` they are folded into the transition, with products to second order. Neglected terms, relative to the
/// entry over a second: 1e-5 for navigation states; for sensor columns 1e-4 if force or attitude change at 1.5 Hz, beta
/// kSubstep / 2 for states that the navigator holds constant over a fold, and the sensor errors themselves (1e-3 for 1000 ppm).
class TransitionAccumulator {
 public:
  static constexpr double kSubstep = 0.05;  ///< s
  /// Whether the pending time is long enough to fold, with a tolerance for rounding of summed intervals.
  [[nodiscard]] static constexpr bool substep_due(double pending) { return pending >= kSubstep - 1e-6; }

  TransitionAccumulator(const StateLayout& layout, double earth_rate);

  void reset();
  /// Sets the white noise from now on, as StateLayout::gyro_noise_b() has it; until then that of the layout is used.
  void set_white_noise(const Eigen::Matrix3d& gyro_noise_b, const Eigen::Matrix3d& accel_noise_b) {
    gyro_noise_b_ = gyro_noise_b;
    accel_noise_b_ = accel_noise_b;
  }
  /// Accumulates the white noise of each axis too.
  void split_white_noise() { splits_ = true; }
  void add(const SampleDynamics& sample);
  [[nodiscard]] bool substep_due() const { return substep_due(fold_.h); }
  /// Folds what is pending. @param gravity_gradient dg/dr at the position, 1/s^2
  void fold(const Eigen::Matrix3d& gravity_gradient);

  /// For three navigation states that are reset at the end of the interval: removes their dependence on the interval.
  void forget(int first_state) {
    Phi_n_.middleRows<3>(first_state).setZero();
    for_each_covariance([&](NavCov& Q) {
      Q.middleRows<3>(first_state).setZero();
      Q.middleCols<3>(first_state).setZero();
    });
  }

  [[nodiscard]] const NavRows& Phi_n() const { return Phi_n_; }
  [[nodiscard]] const NavCov& Q_n() const { return Q_n_; }
  /// The part of Q_n() that is the gyros'.
  [[nodiscard]] const NavCov& Q_gyro() const { return Q_gyro_; }
  /// Its parts by axis; zero without split_white_noise().
  [[nodiscard]] const AxisNoise& Q_axes() const { return Q_axes_; }
  [[nodiscard]] double elapsed() const { return elapsed_; }

  /// P <- Phi P Phi' + Q over what has been folded since reset(), every block of states included. The effect of driving noise
  /// of sensor states on navigation states within the interval has a closed form for a response that grows like a power of time
  /// (Brown & Hwang); intervals must be short compared with the states' correlation times.
  /// @param renews_gnss_error  see BlockTransitions::over
  void propagate_covariance(Eigen::MatrixXd& P, bool renews_gnss_error);

 private:
  void add_sensor_columns();
  void add_driven_covariance(Eigen::MatrixXd& P) const;
  void add_white_noise();
  void clear_pending();
  template <typename Do>
  void for_each_covariance(const Do& act) {
    act(Q_n_);
    act(Q_gyro_);
    if (splits_) std::ranges::for_each(Q_axes_, act);
  }

  const StateLayout& layout_;
  double earth_rate_;
  Eigen::Matrix3d gyro_noise_b_, accel_noise_b_;
  NavRows Phi_n_;
  NavCov Q_n_;
  NavCov Q_gyro_;
  AxisNoise Q_axes_;
  bool splits_ = false;
  int gyro_states_ = 0;
  Eigen::RowVectorXd output_;  ///< h Phi(elapsed) of every sensor state: current output per unit of the state at the knot
  Eigen::RowVectorXd middle_;  ///< the same in the middle of the fold
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> effect_;  ///< of every sensor state on its integral, over the fold
  BlockTransitions over_half_fold_;
  BlockTransitions over_interval_;
  double elapsed_ = 0.0;
  bool multiplicative_ = false;  ///< whether any sensor state multiplies a signal

  Fold fold_;                                    ///< pending
  Eigen::Matrix3d sum_C_;                        ///< integral of C over the fold
  std::array<Eigen::Matrix3d, 3> sum_C_dtheta_;  ///< sums of C dtheta_k, k = x, y, z of b
  std::array<Eigen::Matrix3d, 3> sum_C_dv_;
};

template <typename Rows>
void Fold::advance(Rows& rows, const Eigen::Matrix3d& G, double earth_rate) const {
  const double wh = earth_rate * h;
  auto r = rows.template middleRows<3>(kPos);
  auto v = rows.template middleRows<3>(kVel);
  auto psi = rows.template middleRows<3>(kPsi);

  const auto gravity_kick = [&](double dt) {
    for (int i = 0; i < 3; ++i) v.row(i) += (dt * G(i, 0)) * r.row(0) + (dt * G(i, 1)) * r.row(1) + (dt * G(i, 2)) * r.row(2);
  };
  // Earth rotation; using the new first component for the second gives an error of (angle)^2, 1e-11 per fold, and needs no
  // temporary.
  const auto turn = [](auto block, double angle) {
    block.row(0) += angle * block.row(1);
    block.row(1) -= angle * block.row(0);
  };
  const auto minus_cross_psi = [&](auto block, const Eigen::Vector3d& a) {  // block -= [a x] psi
    block.row(0) += a.z() * psi.row(1) - a.y() * psi.row(2);
    block.row(1) += a.x() * psi.row(2) - a.z() * psi.row(0);
    block.row(2) += a.y() * psi.row(0) - a.x() * psi.row(1);
  };

  gravity_kick(0.5 * h);
  r += h * v;
  minus_cross_psi(r, double_f);
  turn(v, 2.0 * wh);
  turn(psi, 0.5 * wh);
  minus_cross_psi(v, sum_f);  // psi at mid-interval
  turn(psi, 0.5 * wh);
  gravity_kick(0.5 * h);
}

template <typename Rows, typename Effect>
void Fold::add_gyro_errors(Rows&& rows, const Effect& effect) const {
  const auto add_tilt = [&](int first, double factor) {
    const Eigen::Vector3d f = factor * sum_f;
    rows.row(first) += f.y() * effect.row(2) - f.z() * effect.row(1);
    rows.row(first + 1) += f.z() * effect.row(0) - f.x() * effect.row(2);
    rows.row(first + 2) += f.x() * effect.row(1) - f.y() * effect.row(0);
  };
  rows.template middleRows<3>(kPsi) -= effect;
  add_tilt(kVel, 0.5);
  add_tilt(kPos, h / 6.0);
}

template <typename Rows, typename Effect>
void Fold::add_accel_errors(Rows&& rows, const Effect& effect) const {
  rows.template middleRows<3>(kVel) -= effect;
  rows.template middleRows<3>(kPos) -= (0.5 * h) * effect;
}

}  // namespace coast::estimate
