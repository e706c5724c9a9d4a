#include "propagation.hpp"

#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/ins/gap.hpp"

namespace coast::estimate {

namespace {

// Uncertainty of the motion while IMU samples are missing: errors of the bridged rate (ins/gap.hpp) and specific force
// that last for a manoeuvre.
constexpr double kGapForceSd = 3.0;  // m/s^2
constexpr double kManoeuvre = 0.5;   // s, correlation time
// After a gap of any length, a land, sea or air vehicle is near level and has a speed typical of its kind. The heading may have
// any value; the filter is linear, and larger values do not help it.
constexpr double kGapTiltMax = 0.25;      // rad
constexpr double kGapHeadingMax = 1.0;    // rad
constexpr double kGapVelocityMax = 30.0;  // m/s
constexpr double kCoastingGap = 5.0;      // s
constexpr double kLostPosition = 100.0;   // m

// Of the integral over t of an exponentially correlated error of unit variance, s^2: t^2 for short t, 2 tau t for long t,
// independent of the division into intervals.
double integrated_variance(double t) {
  const double periods = t / kManoeuvre;
  return 2.0 * kManoeuvre * kManoeuvre * (periods + std::expm1(-periods));
}

// Adds variance along N, E and D, to at most the bound of each axis.
void add_bounded(Eigen::Ref<Eigen::MatrixXd> P, const Eigen::Matrix3d& C_n_e, double added, const Eigen::Vector3d& largest_sd) {
  const Eigen::Vector3d now = (C_n_e.transpose() * P * C_n_e).diagonal();
  const Eigen::Vector3d room = (largest_sd.cwiseAbs2() - now).cwiseMax(0.0);
  P += C_n_e * room.cwiseMin(added).asDiagonal() * C_n_e.transpose();
}

}  // namespace

Propagation::Propagation(const Mission& mission, const StateLayout& layout)
    : mission_(mission),
      layout_(layout),
      navigator_(layout, mission.increments, mission.earth_rate),
      transition_(layout, mission.earth_rate) {}

void Propagation::set(const Navigator::Start& start) {
  navigator_.set(start);
  transition_.reset();
  gap_ = gap_before_ = 0.0;
}

void Propagation::correct(const record::NavState& nav, const Eigen::VectorXd& x) {
  navigator_.correct(nav, x);
  transition_.reset();
}

void Propagation::step(const SampleStep& step) {
  if (step.span) missing_share_ = missing_share(mission_.imu, *step.span);
  if (missing_share_ == 0.0) gap_before_ = 0.0;
  SampleDynamics dynamics = navigator_.propagate(step.raw);
  if (step.coasting) dynamics.without_sensors();
  transition_.add(dynamics);
  gap_ += missing_share_ * step.raw.dt;
  if (transition_.substep_due()) fold();
  navigator_.set_time(step.at);
}

void Propagation::fold() {
  follow_noise_level();
  transition_.fold(navigator_.gravity_gradient());
  navigator_.advance_sensor_states();
}

// The level at the middle of a substep is used for all of it.
void Propagation::follow_noise_level() {
  const std::vector<record::NoiseLevel>& levels = mission_.imu.noise;
  if (levels.empty()) return;
  const geo::GpsTime t = navigator_.nav().t - 0.5 * TransitionAccumulator::kSubstep;
  const std::size_t before = noise_level_;
  while (noise_level_ + 1 < levels.size() && levels[noise_level_].to <= t) ++noise_level_;
  if (noise_level_ == before && noise_level_ > 0) return;
  const record::NoiseLevel& level = levels[noise_level_];
  transition_.set_white_noise(layout_.gyro_noise_b() * level.gyro.cwiseSqrt().asDiagonal(),
                              layout_.accel_noise_b() * level.accel.cwiseSqrt().asDiagonal());
}

void Propagation::add_gap_noise(Eigen::MatrixXd& P) {
  if (gap_ == 0.0) return;
  const double grown = integrated_variance(gap_before_ + gap_) - integrated_variance(gap_before_);
  gap_before_ += gap_;
  const double psi2 = ins::kGapRateSd * ins::kGapRateSd * grown;
  const double v2 = kGapForceSd * kGapForceSd * grown;
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(navigator_.nav().r_eb_e));
  add_bounded(P.block<3, 3>(kPsi, kPsi), C_n_e, psi2, {kGapTiltMax, kGapTiltMax, kGapHeadingMax});
  add_bounded(P.block<3, 3>(kVel, kVel), C_n_e, v2, Eigen::Vector3d::Constant(kGapVelocityMax));
  P.diagonal().segment<3>(kPos).array() += 0.25 * std::pow(kGapForceSd * gap_ * gap_, 2);
  gap_ = 0.0;
}

void Propagation::close(Eigen::MatrixXd& P) {
  fold();
  renewed_gnss_error_ = layout_.gnss_error() && new_ambiguities_at(mission_, navigator_.nav().t);
  transition_.propagate_covariance(P, renewed_gnss_error_);
  if (renewed_gnss_error_) {
    Eigen::VectorXd x = navigator_.x();
    x.segment<3>(*layout_.gnss_error()).setZero();
    navigator_.correct(navigator_.nav(), x);
  }
  add_gap_noise(P);
  if (const Restart* at = restart_at(mission_, navigator_.nav().t)) restart(*at, P);
}

// Fixes in and after the gap keep position and velocity, in which the filter is linear. If there were none for long, the
// start's are better, and a covariance of kilometres next to centimetres would lose digits.
void Propagation::restart(const Restart& at, Eigen::MatrixXd& P) {
  record::NavState nav = navigator_.nav();
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(at.nav.r_eb_e));
  const auto anew = [&](int first, const Eigen::Vector3d& sd_n) {
    P.middleRows<3>(first).setZero();
    P.middleCols<3>(first).setZero();
    P.block<3, 3>(first, first) = C_n_e * sd_n.cwiseAbs2().asDiagonal() * C_n_e.transpose();
    transition_.forget(first);
  };
  if (at.sd_attitude_n) {
    anew(kPsi, *at.sd_attitude_n);
    nav.q_b_e = at.nav.q_b_e;
  }
  if (P.block<3, 3>(kPos, kPos).trace() > kLostPosition * kLostPosition) {
    anew(kPos, at.sd_position_n);
    anew(kVel, at.sd_velocity_n);
    nav.r_eb_e = at.nav.r_eb_e;
    nav.v_eb_e = at.nav.v_eb_e;
    tie_position_to_fixes(layout_, P);
  }
  navigator_.correct(nav, navigator_.x());
}

bool new_ambiguities_at(const Mission& mission, geo::GpsTime t) {
  const std::vector<record::GnssFix>& fixes = mission.gnss.fixes;
  const geo::GpsTime tag = t + mission.time_offset_s;
  const auto fix = std::ranges::lower_bound(fixes, tag - kTimeTolerance, {}, &record::GnssFix::t);
  if (fix == fixes.begin() || fix == fixes.end() || fix->t > tag + kTimeTolerance) return false;
  return (fix->quality == record::FixQuality::kFixed) != (std::prev(fix)->quality == record::FixQuality::kFixed);
}

const Restart* restart_at(const Mission& mission, geo::GpsTime t) {
  const auto found = std::ranges::find_if(
      mission.restarts, [t](const Restart& restart) { return std::abs(restart.nav.t - t) <= kTimeTolerance; });
  return found == mission.restarts.end() ? nullptr : &*found;
}

bool is_long_gap(const record::ImuRecording& imu, double span) {
  return span - 1.0 / imu.rate_hz > kCoastingGap;
}

double missing_share(const record::ImuRecording& imu, double span) {
  const double missing = span - 1.0 / imu.rate_hz;
  return missing > 0.5 / imu.rate_hz ? missing / span : 0.0;
}

UpdateContext update_context(const Mission& mission, const StateLayout& layout, const SampleCursor& cursor,
                             const Navigator& navigator, const Eigen::Matrix3d& C_n_e) {
  ins::RawIncrement next = cursor.remainder;
  if (next.dt == 0.0 && cursor.next_sample < mission.imu.samples.size()) {
    const record::ImuSample& sample = mission.imu.samples[cursor.next_sample];
    if (missing_share(mission.imu, sample.t - navigator.nav().t) == 0.0) next = {sample.dt, sample.dtheta, sample.dv};
  }
  return {layout, mission.lever_arm_b, navigator.omega_eb_b(next), C_n_e};
}

record::NavState repeat_nominal(const Mission& mission, const Knot& knot, geo::GpsTime end, Navigator& navigator,
                                std::vector<record::NavState>& epochs) {
  navigator.set(knot.post);
  SampleCursor cursor{knot.next_sample, knot.remainder};
  double pending = 0.0;
  walk(mission.imu, cursor, end, navigator, [&](const SampleStep& step) {
    navigator.propagate(step.raw);
    navigator.set_time(step.at);
    if (step.whole) epochs.push_back(navigator.nav());
    pending += step.raw.dt;
    if (TransitionAccumulator::substep_due(pending)) {  // the same instants as in the forward pass
      navigator.advance_sensor_states();
      pending = 0.0;
    }
  });
  return navigator.nav();
}

}  // namespace coast::estimate
