#include "coast/study/comparison.hpp"

#include <algorithm>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::study {

ErrorSample error_of(const record::TrajectoryEpoch& estimate, const record::NavState& reference) {
  const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(reference.r_eb_e)).transpose();
  const geo::Euler a = geo::euler_from_dcm(C_e_n * estimate.nav.q_b_e.toRotationMatrix());
  const geo::Euler b = geo::euler_from_dcm(C_e_n * reference.q_b_e.toRotationMatrix());
  ErrorSample e;
  e.t = reference.t;
  e.position_n = C_e_n * (estimate.nav.r_eb_e - reference.r_eb_e);
  e.velocity_n = C_e_n * (estimate.nav.v_eb_e - reference.v_eb_e);
  e.attitude = {geo::wrap_angle(a.roll - b.roll), geo::wrap_angle(a.pitch - b.pitch), geo::wrap_angle(a.yaw - b.yaw)};
  e.sd_position = estimate.cov.position.diagonal().cwiseSqrt();
  const Eigen::Matrix3d J = geo::euler_jacobian(a);
  e.sd_attitude = (J * estimate.cov.attitude * J.transpose()).diagonal().cwiseSqrt();
  return e;
}

Comparison::Comparison(const record::Trajectory& reference, Eigen::Vector3d lever_arm_b)
    : reference_(reference), lever_arm_b_(std::move(lever_arm_b)) {}

void Comparison::add(const record::TrajectoryEpoch& epoch) {
  const auto& states = reference_.states;
  if (!previous_) {  // the reference may begin long before
    next_ = static_cast<std::size_t>(std::lower_bound(states.begin(), states.end(), epoch.nav.t,
                                                      [](const record::NavState& nav, geo::GpsTime t) { return nav.t < t; }) -
                                     states.begin());
  }
  for (; next_ < states.size() && states[next_].t <= epoch.nav.t; ++next_) {
    record::TrajectoryEpoch at = epoch;
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    if (previous_) {
      at.nav = interpolate(previous_->nav, epoch.nav, states[next_].t);
      rate = mean_rate(previous_->nav, epoch.nav);
    }
    at.nav = at_point(at.nav, lever_arm_b_, rate);
    errors_.push_back(error_of(at, states[next_]));
  }
  previous_ = epoch;
}

ErrorSummary Comparison::summary() const {
  ErrorSummary s;
  s.epochs = errors_.size();
  if (errors_.empty()) return s;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d attitude = Eigen::Vector3d::Zero();
  for (const ErrorSample& e : errors_) {
    s.position_rms_m += e.position_n.cwiseAbs2();
    s.position_max_m = s.position_max_m.cwiseMax(e.position_n.cwiseAbs());
    velocity += e.velocity_n.cwiseAbs2();
    attitude += e.attitude.cwiseAbs2();
  }
  const double n = static_cast<double>(errors_.size());
  s.position_rms_m = (s.position_rms_m / n).cwiseSqrt();
  if (reference_.has_velocity) s.velocity_rms_mps = (velocity / n).cwiseSqrt();
  if (reference_.has_attitude) s.attitude_rms = (attitude / n).cwiseSqrt();
  return s;
}

}  // namespace coast::study
