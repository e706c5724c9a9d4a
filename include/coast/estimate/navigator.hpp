#pragma once
// The nominal trajectory between two corrections: raw increments, freed of the estimated sensor errors, through the strapdown.

#include <Eigen/Core>

#include "coast/estimate/state_layout.hpp"
#include "coast/estimate/transition.hpp"
#include "coast/ins/reversal.hpp"
#include "coast/ins/strapdown.hpp"

namespace coast::estimate {

/// Runs forward deterministically: started again from the same state it repeats the same nominal trajectory (to 2e-9 m/s^2, by
/// where the strapdown last renewed its gravity), which is how smoothed epochs between knots are made without storing the
/// IMU-rate trajectory.
class Navigator {
 public:
  Navigator(const StateLayout& layout, ins::IncrementKind kind, double earth_rate);

  /// Everything that decides how the nominal trajectory goes on.
  struct Start {
    record::NavState nav;
    Eigen::VectorXd x;           ///< size of the layout
    ins::RawIncrement previous;  ///< corrected increment before, for coning; dt = 0 where there is none
  };
  void set(const Start& start);
  /// Position, velocity, attitude and sensor states after an update; the time and the previous increment stay.
  void correct(const record::NavState& nav, const Eigen::VectorXd& x);

  /// One step with an increment as recorded (body axes). @return what the covariance needs of it
  const SampleDynamics& propagate(const ins::RawIncrement& raw);
  /// What this IMU, with its estimated errors, would record over `dt` at constant velocity and attitude against the Earth.
  [[nodiscard]] ins::RawIncrement coasting(double dt) const;
  /// The two parts of an increment as recorded that a knot inside it makes.
  /// @param fraction  of its interval, of the first part
  [[nodiscard]] ins::SplitIncrement split(const ins::RawIncrement& raw, double fraction) const;
  /// Moves the estimated sensor states over the time since the last call. Call where the transition is folded.
  void advance_sensor_states();
  void set_time(geo::GpsTime t) { strapdown_.set_time(t); }

  [[nodiscard]] const record::NavState& nav() const { return strapdown_.state(); }
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] const ins::RawIncrement& previous() const { return previous_; }
  [[nodiscard]] const Eigen::Matrix3d& gravity_gradient() const { return strapdown_.gravity_gradient(); }
  /// Rate against the Earth now, between the last step and the increment that follows, body axes, rad/s. With one of them alone
  /// it would be half an interval old or early: millimetres a second at a lever arm of a metre in a shaking body.
  /// @param next  as recorded; dt = 0 where there is none
  [[nodiscard]] Eigen::Vector3d omega_eb_b(const ins::RawIncrement& next) const;

 private:
  void refresh_corrections();
  /// Freed of the estimated errors.
  [[nodiscard]] ins::RawIncrement without_errors(const ins::RawIncrement& raw) const;

  const StateLayout& layout_;
  ins::IncrementKind kind_;
  ins::Strapdown strapdown_;
  Eigen::VectorXd x_;
  BlockTransitions blocks_;
  ins::RawIncrement previous_;
  SampleDynamics last_;
  Eigen::Matrix3d C_before_;
  double pending_ = 0.0;
  // truth = inverse * measured - offset * dt, in b
  Eigen::Matrix3d gyro_inverse_;
  Eigen::Matrix3d accel_inverse_;
  Eigen::Vector3d gyro_offset_;   ///< rad/s
  Eigen::Vector3d accel_offset_;  ///< m/s^2
};

}  // namespace coast::estimate
