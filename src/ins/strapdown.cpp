#include "coast/ins/strapdown.hpp"

#include <cmath>

#include "coast/geo/rotation.hpp"

namespace coast::ins {
namespace {

// Integral of exp([th s x]) over s in [0, 1], applied to v: effect of a constant rate on a constant specific force.
// (1 - cos a)/a^2 and (a - sin a)/a^3 by their series below a^2 = 0.05 (remainders below 1e-15), where the closed forms cancel.
Eigen::Vector3d integrated_rotation(const Eigen::Vector3d& th, const Eigen::Vector3d& v) {
  const double a2 = th.squaredNorm();
  double first = 0.0;
  double second = 0.0;
  if (a2 < 0.05) {
    first = 1.0 / 2.0 - a2 * (1.0 / 24.0 - a2 * (1.0 / 720.0 - a2 * (1.0 / 40320.0 - a2 / 3628800.0)));
    second = 1.0 / 6.0 - a2 * (1.0 / 120.0 - a2 * (1.0 / 5040.0 - a2 * (1.0 / 362880.0 - a2 / 39916800.0)));
  } else {
    const double a = std::sqrt(a2);
    first = (1.0 - std::cos(a)) / a2;
    second = (a - std::sin(a)) / (a2 * a);
  }
  const Eigen::Vector3d cross = th.cross(v);
  return v + first * cross + second * th.cross(cross);
}

// One Newton step towards unit norm: the products above leave |q|^2 - 1 at a few 1e-16, its square is negligible.
Eigen::Quaterniond renormalised(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond(q.coeffs() * (1.5 - 0.5 * q.squaredNorm()));
}

}  // namespace

BodyIncrement compensate_two_sample(const RawIncrement& previous, const RawIncrement& current) {
  BodyIncrement body{current.dt, current.dtheta, integrated_rotation(current.dtheta, current.dv)};
  if (previous.dt > 0.0) {
    const double c = current.dt * current.dt / (6.0 * previous.dt * (previous.dt + current.dt));
    body.phi += c * previous.dtheta.cross(current.dtheta);
    body.u += c * (previous.dtheta.cross(current.dv) + previous.dv.cross(current.dtheta));
  }
  return body;
}

SplitIncrement split(const RawIncrement& previous, const RawIncrement& current, double fraction) {
  // The part up to `fraction` of a line through the mean rates at both intervals' middles, minus that of a constant.
  Eigen::Vector3d dtheta = fraction * current.dtheta;
  Eigen::Vector3d dv = fraction * current.dv;
  if (previous.dt > 0.0) {
    const double bend = fraction * (fraction - 1.0) * current.dt / (previous.dt + current.dt);
    const double ratio = current.dt / previous.dt;
    dtheta += bend * (current.dtheta - ratio * previous.dtheta);
    dv += bend * (current.dv - ratio * previous.dv);
  }
  SplitIncrement parts;
  parts.first = {fraction * current.dt, dtheta, dv};
  parts.second = {current.dt - parts.first.dt, current.dtheta - dtheta, current.dv - dv};
  return parts;
}

Strapdown::Strapdown(const record::NavState& start, double earth_rate) : state_(start), earth_rate_(earth_rate) {
  correct(start.r_eb_e, start.v_eb_e, start.q_b_e);
}

void Strapdown::step(const BodyIncrement& increment) {
  const double dt = increment.dt;
  const double half_turn = 0.5 * earth_rate_ * dt;  // of the Earth

  // Specific force: the start attitude relative to the e-frame at mid-interval, rotated by -w dt/2 about z.
  const Eigen::Vector3d dv_start = C_b_e_ * increment.u;
  last_dv_e_ = {dv_start.x() + half_turn * dv_start.y(), dv_start.y() - half_turn * dv_start.x(), dv_start.z()};

  // Gravity and Coriolis at mid-interval; v_mid from the derivative at the start, its error is of order (w dt)^2 dv.
  const Eigen::Vector3d& v = state_.v_eb_e;
  const Eigen::Vector3d& g_e = gravity_.at(state_.r_eb_e + (0.5 * dt) * v);
  const Eigen::Vector3d dv_free = last_dv_e_ + dt * g_e;
  const double coriolis = 2.0 * earth_rate_ * dt;
  const double half = 0.5 * coriolis;
  const double vx_mid = v.x() + 0.5 * dv_free.x() + half * v.y();
  const double vy_mid = v.y() + 0.5 * dv_free.y() - half * v.x();
  const Eigen::Vector3d v_next(v.x() + dv_free.x() + coriolis * vy_mid, v.y() + dv_free.y() - coriolis * vx_mid,
                               v.z() + dv_free.z());
  state_.r_eb_e += (0.5 * dt) * (v + v_next);
  state_.v_eb_e = v_next;

  // C_b_e(end) = Rz(-w dt) C_b_e(start) exp([phi x]).
  const Eigen::Quaterniond q_earth(std::cos(half_turn), 0.0, 0.0, -std::sin(half_turn));
  state_.q_b_e = renormalised(q_earth * state_.q_b_e * geo::quaternion_from_rotation_vector(increment.phi));
  C_b_e_ = state_.q_b_e.toRotationMatrix();
  state_.t = state_.t + dt;
}

void Strapdown::correct(const Eigen::Vector3d& r_eb_e, const Eigen::Vector3d& v_eb_e, const Eigen::Quaterniond& q_b_e) {
  state_.r_eb_e = r_eb_e;
  state_.v_eb_e = v_eb_e;
  state_.q_b_e = q_b_e.normalized();
  C_b_e_ = state_.q_b_e.toRotationMatrix();
}

}  // namespace coast::ins
