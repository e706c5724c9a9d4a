#include "coast/study/marked_states.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::study {

namespace {

record::NavCovariance blended(const record::NavCovariance& a, const record::NavCovariance& b, double share) {
  return {(1.0 - share) * a.position + share * b.position, (1.0 - share) * a.velocity + share * b.velocity,
          (1.0 - share) * a.attitude + share * b.attitude};
}

/// Adds what an attitude error does to a vector that is fixed to the body.
void add_turned(const Eigen::Vector3d& v_n, const Eigen::Matrix3d& attitude, Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d H = geo::skew(v_n);  // d(C v) = psi x C v
  covariance += H * attitude * H.transpose();
}

}  // namespace

MarkedStates::MarkedStates(std::vector<record::TimeMark> marks, double delay_s, const Mounted& mounted,
                           double longest_interval_s)
    : marks_(std::move(marks)), delay_s_(delay_s), mounted_(mounted), longest_interval_s_(longest_interval_s) {}

void MarkedStates::add(const record::TrajectoryEpoch& epoch) {
  omega_eb_b_ = motion_.at(epoch.nav).omega_eb_b;
  for (; next_ < marks_.size(); ++next_) {
    const record::TimeMark& mark = marks_[next_];
    const geo::GpsTime t = mark.t + delay_s_;
    if (t > epoch.nav.t || (!previous_ && t == epoch.nav.t)) break;
    if (!previous_)
      missed_.push_back({mark, MissedMark::Why::kBefore});
    else if (epoch.nav.t - previous_->nav.t > longest_interval_s_ && t != previous_->nav.t && t != epoch.nav.t)
      missed_.push_back({mark, MissedMark::Why::kGap});
    else
      states_.push_back(between(epoch, mark, t));
  }
  previous_ = epoch;
}

void MarkedStates::finish() {
  for (; next_ < marks_.size(); ++next_) missed_.push_back({marks_[next_], MissedMark::Why::kAfter});
}

record::MarkedState MarkedStates::between(const record::TrajectoryEpoch& epoch, const record::TimeMark& mark,
                                          geo::GpsTime t) const {
  const record::TrajectoryEpoch& before = *previous_;
  const double share = (t - before.nav.t) / (epoch.nav.t - before.nav.t);
  const record::NavState body = interpolate(before.nav, epoch.nav, t);
  record::MarkedState state{mark, at_point(body, mounted_.lever_arm_b, omega_eb_b_), blended(before.cov, epoch.cov, share)};
  state.nav.q_b_e = body.q_b_e * Eigen::Quaterniond(mounted_.C_s_b);
  const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(body.r_eb_e)).transpose();
  record::NavCovariance& cov = state.cov;
  add_turned(C_e_n * (state.nav.r_eb_e - body.r_eb_e), cov.attitude, cov.position);
  add_turned(C_e_n * (state.nav.v_eb_e - body.v_eb_e), cov.attitude, cov.velocity);
  const Eigen::Vector3d moved_n = mark.sd_s * (C_e_n * state.nav.v_eb_e);
  const Eigen::Vector3d turned_n = mark.sd_s * (C_e_n * (body.q_b_e * omega_eb_b_));
  cov.position += moved_n * moved_n.transpose();
  cov.attitude += turned_n * turned_n.transpose();
  return state;
}

std::optional<DelayEstimate> estimate_delay(const std::vector<record::MarkedState>& states) {
  constexpr std::size_t kLeast = 4;
  constexpr double kSameVelocity = 1e-6;  // of the sum of squares: behind it the delay is not separable from an offset
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double squares = 0.0;
  DelayEstimate found;
  for (const record::MarkedState& state : states) {
    if (!state.mark.r_e) continue;
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(state.nav.r_eb_e)).transpose();
    const Eigen::Vector2d z = (C_e_n * (*state.mark.r_e - state.nav.r_eb_e)).head<2>();
    Eigen::Matrix<double, 2, 3> H;
    H << (C_e_n * state.nav.v_eb_e).head<2>(), Eigen::Matrix2d::Identity();
    N += H.transpose() * H;
    b += H.transpose() * z;
    squares += z.squaredNorm();
    ++found.marks;
  }
  if (found.marks < kLeast) return std::nullopt;
  const double n = static_cast<double>(found.marks);
  const double varied = N(0, 0) - (N(0, 1) * N(0, 1) + N(0, 2) * N(0, 2)) / n;  // of the velocity about its mean
  if (!(varied > kSameVelocity * N(0, 0)) || !(varied > 1.0)) return std::nullopt;
  const Eigen::Vector3d x = N.ldlt().solve(b);
  const double variance = std::max(0.0, squares - b.dot(x)) / (2.0 * n - 3.0);
  found.delay_s = x(0);
  found.offset_n = x.tail<2>();
  found.sd_s = std::sqrt(variance / varied);
  found.residual_m = std::sqrt(variance);
  return found;
}

}  // namespace coast::study
