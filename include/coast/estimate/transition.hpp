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

/// Covariance that white noise brings into the navigation states over an interval, each sensor's own.
struct WhiteNoise {
  NavCov gyro;
  NavCov accel;
};

/// What one IMU sample contributes; the strapdown has it at hand.
struct SampleDynamics {
  double dt = 0.0;
  Eigen::Matrix3d C_b_e;     ///< at the middle of the interval (mean of both ends)
  Eigen::Vector3d dv_e;      ///< integral of C f, m/s
  Eigen::Vector3d dtheta_b;  ///< rotation over the interval, rad
  Eigen::Vector3d dv_b;      ///< specific-force increment in b, m/s
};

/// The sums of some samples that move the navigation errors as one step.
struct Fold {
  double h = 0.0;                                      ///< its length, s
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
  /// What errors of sensor errors do by the end of the fold. Gyro: attitude takes the effect, velocity half the cross product
  /// with it, position a sixth; accelerometer: velocity, position half.
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
  [[nodiscard]] bool substep_due() const { return substep_due(fold_.h); }
  /// Folds what is pending. @param gravity_gradient dg/dr at the position, 1/s^2
  void fold(const Eigen::Matrix3d& gravity_gradient);

  /// Three navigation states are found anew at the end of the interval: nothing of it reaches them.
  void forget(int first_state) {
    Phi_n_.middleRows<3>(first_state).setZero();
    for (NavCov* Q : {&Q_n_, &Q_gyro_}) {
      Q->middleRows<3>(first_state).setZero();
      Q->middleCols<3>(first_state).setZero();
    }
  }

  [[nodiscard]] const NavRows& Phi_n() const { return Phi_n_; }
  [[nodiscard]] const NavCov& Q_n() const { return Q_n_; }
  [[nodiscard]] WhiteNoise white_noise() const { return {Q_gyro_, Q_n_ - Q_gyro_}; }
  [[nodiscard]] double elapsed() const { return elapsed_; }

  /// P <- Phi P Phi' + Q over what has been folded since reset(), every block of states included. Driving noise of sensor
  /// states reaches the navigation states within the interval by the closed form for a response that grows like a power of
  /// time (Brown & Hwang); intervals must be short against the states' correlation times.
  void propagate_covariance(Eigen::MatrixXd& P);

 private:
  void add_sensor_columns();
  void add_driven_covariance(Eigen::MatrixXd& P) const;
  void add_white_noise();
  void clear_pending();

  const StateLayout& layout_;
  double earth_rate_;
  Eigen::Matrix3d gyro_density_b_, accel_density_b_;
  NavRows Phi_n_;
  NavCov Q_n_;
  NavCov Q_gyro_;  ///< the gyros' part of it
  int gyro_states_ = 0;
  Eigen::RowVectorXd output_;  ///< h Phi(elapsed) of every sensor state: what a unit of it at the knot does now
  Eigen::RowVectorXd middle_;  ///< the same in the middle of the fold
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> effect_;  ///< of every sensor state on its integral, over the fold
  BlockTransitions over_half_fold_;
  BlockTransitions over_interval_;
  double elapsed_ = 0.0;
  bool multiplicative_ = false;  ///< whether any sensor state multiplies a signal

  Fold fold_;                                    ///< pending
  Eigen::Matrix3d sum_C_;                        ///< integral of C over it
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
  // Earth rotation; taking the new first component for the second costs (angle)^2, 1e-11 a fold, and needs no temporary.
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
