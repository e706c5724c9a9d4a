#include "coast/estimate/navigator.hpp"

#include <Eigen/LU>

#include "coast/geo/earth.hpp"
#include "coast/ins/compensation.hpp"

namespace coast::estimate {

Navigator::Navigator(const StateLayout& layout, ins::IncrementKind kind, double earth_rate)
    : layout_(layout),
      kind_(kind),
      strapdown_(record::NavState{}, earth_rate),
      x_(Eigen::VectorXd::Zero(layout.size())),
      blocks_(layout) {
  refresh_corrections();
}

void Navigator::set(const Start& start) {
  previous_ = start.previous;
  correct(start.nav, start.x);
  set_time(start.nav.t);
}

void Navigator::correct(const record::NavState& nav, const Eigen::VectorXd& x) {
  strapdown_.correct(nav.r_eb_e, nav.v_eb_e, nav.q_b_e);
  x_ = x;
  pending_ = 0.0;
  refresh_corrections();
}

void Navigator::refresh_corrections() {
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero(), accel_bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyro_gain = Eigen::Matrix3d::Identity(), accel_gain = Eigen::Matrix3d::Identity();
  for (const auto& block : layout_.sensors()) {
    const double error =
        block.size == 1 ? block.output(0) * x_(block.offset) : block.output.dot(x_.segment(block.offset, block.size));
    const bool gyro = block.sensor == noise::Sensor::kGyro;
    if (block.signal_b)
      (gyro ? gyro_gain : accel_gain) += error * block.response_b * block.signal_b->transpose();
    else
      (gyro ? gyro_bias : accel_bias) += error * block.response_b;
  }
  // measured = bias + gain * truth
  gyro_inverse_ = gyro_gain.inverse();
  accel_inverse_ = accel_gain.inverse();
  gyro_offset_ = gyro_inverse_ * gyro_bias;
  accel_offset_ = accel_inverse_ * accel_bias;
}

ins::RawIncrement Navigator::without_errors(const ins::RawIncrement& raw) const {
  return {raw.dt, gyro_inverse_ * raw.dtheta - raw.dt * gyro_offset_, accel_inverse_ * raw.dv - raw.dt * accel_offset_};
}

// dv_e/dt = C_b_e f + g - 2 omega_ie x v = 0        Groves (2013, 2nd ed.) eq. (5.36)
ins::RawIncrement Navigator::coasting(double dt) const {
  const Eigen::Matrix3d C_e_b = strapdown_.C_b_e().transpose();
  const Eigen::Vector3d omega_ie_e(0.0, 0.0, strapdown_.earth_rate());
  const Eigen::Vector3d force_e = 2.0 * omega_ie_e.cross(nav().v_eb_e) - geo::gravity_e(nav().r_eb_e);
  const Eigen::Vector3d omega_b = C_e_b * omega_ie_e;
  return {dt, dt * gyro_inverse_.partialPivLu().solve(omega_b + gyro_offset_),
          dt * accel_inverse_.partialPivLu().solve(C_e_b * force_e + accel_offset_)};
}

// An increment is divided according to its difference from the previous one, both corrected for errors: next to a corrected
// increment the bias of a raw one would look like an acceleration. The correction itself is divided evenly.
ins::SplitIncrement Navigator::split(const ins::RawIncrement& raw, double fraction) const {
  const ins::RawIncrement whole = without_errors(raw);
  ins::SplitIncrement parts = ins::split(previous_, whole, fraction);
  parts.first.dtheta += fraction * (raw.dtheta - whole.dtheta);
  parts.first.dv += fraction * (raw.dv - whole.dv);
  parts.second.dtheta = raw.dtheta - parts.first.dtheta;
  parts.second.dv = raw.dv - parts.first.dv;
  return parts;
}

const SampleDynamics& Navigator::propagate(const ins::RawIncrement& raw) {
  const ins::RawIncrement corrected = without_errors(raw);
  const ins::BodyIncrement increment =
      kind_ == ins::IncrementKind::kRaw
          ? ins::compensate_two_sample(previous_, corrected)
          : ins::without_bias({raw.dt, raw.dtheta, raw.dv}, (raw.dtheta - corrected.dtheta) / raw.dt,
                              (raw.dv - corrected.dv) / raw.dt);
  C_before_ = strapdown_.C_b_e();
  strapdown_.step(increment);
  last_.dt = raw.dt;
  last_.C_b_e = 0.5 * (C_before_ + strapdown_.C_b_e());
  last_.dv_e = strapdown_.last_dv_e();
  last_.dtheta_b = corrected.dtheta;
  last_.dv_b = corrected.dv;
  previous_ = corrected;
  pending_ += raw.dt;
  return last_;
}

void Navigator::advance_sensor_states() {
  blocks_.over(pending_).apply(x_.tail(x_.size() - kNav));
  pending_ = 0.0;
  refresh_corrections();
}

Eigen::Vector3d Navigator::omega_eb_b(const ins::RawIncrement& next) const {
  const Eigen::Vector3d dtheta_next = gyro_inverse_ * next.dtheta - next.dt * gyro_offset_;
  Eigen::Vector3d omega_ib_b = Eigen::Vector3d::Zero();
  // The line through the mean rates at both intervals' middles, at the instant between them.
  if (last_.dt > 0.0 && next.dt > 0.0)
    omega_ib_b = (last_.dtheta_b * (next.dt / last_.dt) + dtheta_next * (last_.dt / next.dt)) / (last_.dt + next.dt);
  else if (last_.dt > 0.0)
    omega_ib_b = last_.dtheta_b / last_.dt;
  else if (next.dt > 0.0)
    omega_ib_b = dtheta_next / next.dt;
  return omega_ib_b - strapdown_.C_b_e().transpose() * Eigen::Vector3d(0.0, 0.0, strapdown_.earth_rate());
}

}  // namespace coast::estimate
