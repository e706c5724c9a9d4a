#include "coast/study/comparison.hpp"

#include <algorithm>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

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

void ErrorStatistics::add_to(Sums& sums, const Eigen::Vector3d& value, const Eigen::Vector3d& sd) {
  const Eigen::Array3d size = value.array().abs();
  sums.squares.array() += size.square();
  sums.max = sums.max.cwiseMax(size.matrix());
  sums.inside.array() += (size <= 1.96 * sd.array()).cast<double>();
}

void ErrorStatistics::add(const ErrorSample& sample) {
  ++epochs_;
  add_to(position_, sample.position_n, sample.sd_position);
  add_to(velocity_, sample.velocity_n, Eigen::Vector3d::Zero());
  add_to(attitude_, sample.attitude, sample.sd_attitude);
}

AxisErrors ErrorStatistics::of(const Sums& sums, bool has_sd) const {
  const double n = std::max(1.0, static_cast<double>(epochs_));
  AxisErrors errors{(sums.squares / n).cwiseSqrt(), sums.max, std::nullopt};
  if (has_sd) errors.inside_95 = sums.inside / n;
  return errors;
}

ErrorSummary ErrorStatistics::summary(bool has_velocity, bool has_attitude) const {
  ErrorSummary s{epochs_, of(position_, true), std::nullopt, std::nullopt};
  if (has_velocity) s.velocity = of(velocity_, false);
  if (has_attitude) s.attitude = of(attitude_, true);
  return s;
}

Comparison::Comparison(const record::Trajectory& reference, Eigen::Vector3d lever_arm_b, Sink sink)
    : reference_(reference), lever_arm_b_(std::move(lever_arm_b)), sink_(std::move(sink)) {}

void Comparison::add(const record::TrajectoryEpoch& epoch) {
  const auto& states = reference_.states;
  if (!previous_) {  // the reference may begin much earlier
    next_ = static_cast<std::size_t>(std::lower_bound(states.begin(), states.end(), epoch.nav.t,
                                                      [](const record::NavState& nav, geo::GpsTime t) { return nav.t < t; }) -
                                     states.begin());
  }
  const Eigen::Vector3d& rate = motion_.at(epoch.nav).omega_eb_b;
  for (; next_ < states.size() && states[next_].t <= epoch.nav.t; ++next_) {
    record::TrajectoryEpoch at = epoch;
    if (previous_) at.nav = interpolate(previous_->nav, epoch.nav, states[next_].t);
    at.nav = at_point(at.nav, lever_arm_b_, rate);
    const ErrorSample error = error_of(at, states[next_]);
    statistics_.add(error);
    if (sink_) sink_(error);
  }
  previous_ = epoch;
}

}  // namespace coast::study
