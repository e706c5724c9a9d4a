#pragma once
// The nominal trajectory between two corrections: strapdown integration of increments corrected for the estimated sensor
// errors.

#include <Eigen/Core>

#include "coast/estimate/state_layout.hpp"
#include "coast/estimate/transition.hpp"
#include "coast/ins/reversal.hpp"
#include "coast/ins/strapdown.hpp"

namespace coast::estimate {

/// Deterministic: from the same state it repeats the same nominal trajectory (to 2e-9 m/s^2, depending on where the strapdown
/// last recomputed gravity). Smoothed epochs between knots are computed this way, without storing the IMU-rate trajectory.
class Navigator {
 public:
  Navigator(const StateLayout& layout, ins::IncrementKind kind, double earth_rate);

  /// Everything that determines the further nominal trajectory.
  struct Start {
    record::NavState nav;
    Eigen::VectorXd x;           ///< size of the layout
    ins::RawIncrement previous;  ///< previous corrected increment, for coning; dt = 0 if there is none
  };
  void set(const Start& start);
  /// Position, velocity, attitude and sensor states after an update; the time and the previous increment are unchanged.
  void correct(const record::NavState& nav, const Eigen::VectorXd& x);

  /// One step with an increment as recorded (body axes). @return the data needed for the covariance
  const SampleDynamics& propagate(const ins::RawIncrement& raw);
  /// The increment that this IMU, with its estimated errors, would record over `dt` at constant velocity and attitude relative
  /// to the Earth.
  [[nodiscard]] ins::RawIncrement coasting(double dt) const;
  /// The two parts of a recorded increment that is split by a knot.
  /// @param fraction  length of the first part over the interval
  [[nodiscard]] ins::SplitIncrement split(const ins::RawIncrement& raw, double fraction) const;
  /// Propagates the estimated sensor states over the time since the last call. Call whenever the transition is folded.
  void advance_sensor_states();
  void set_time(geo::GpsTime t) { strapdown_.set_time(t); }

  [[nodiscard]] const record::NavState& nav() const { return strapdown_.state(); }
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] const ins::RawIncrement& previous() const { return previous_; }
  [[nodiscard]] const Eigen::Matrix3d& gravity_gradient() const { return strapdown_.gravity_gradient(); }
  /// Angular rate relative to the Earth at the current time, mean of the last step and the next increment, body axes, rad/s.
  /// With only one of them it would be half an interval late or early: an error of mm/s at a lever arm of 1 m in a shaking
  /// body.
  /// @param next  as recorded; dt = 0 if there is none
  [[nodiscard]] Eigen::Vector3d omega_eb_b(const ins::RawIncrement& next) const;

 private:
  void refresh_corrections();
  /// Corrected for the estimated errors.
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
