#include "forward_pass.hpp"
#include "antenna.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "coast/geo/earth.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"

namespace coast::estimate {

namespace {

// What is not known of the motion while IMU samples are missing: constant errors of the bridged rate and specific force.
constexpr double kGapRateSd = 0.3;   // rad/s
constexpr double kGapForceSd = 3.0;  // m/s^2

/// What is left of an epoch where only the highest satellites are seen.
carrier::DifferenceEpoch highest(carrier::DifferenceEpoch epoch, std::size_t satellites) {
  std::ranges::sort(epoch.satellites, std::greater{}, &carrier::SatelliteDifference::base_elevation);
  if (epoch.satellites.size() > satellites)
    epoch.satellites.erase(epoch.satellites.begin() + static_cast<std::ptrdiff_t>(satellites), epoch.satellites.end());
  epoch.alone.reset();
  return epoch;
}

geo::GpsTime middle(const record::MemberBlocks::Block& block) {
  return block.from + 0.5 * (block.to - block.from);
}

}  // namespace

record::NavState repeat_nominal(const Mission& mission, const Knot& knot, geo::GpsTime end, Navigator& navigator,
                                std::vector<record::NavState>& epochs) {
  navigator.set(knot.post);
  ins::RawIncrement remainder = knot.remainder;
  double pending = 0.0;
  for (std::size_t i = knot.next_sample; end - navigator.nav().t > kTimeTolerance; ++i) {
    const geo::GpsTime now = navigator.nav().t;
    ins::RawIncrement raw = increment_from(mission.imu, i, remainder, now);
    const bool whole = (end - now) >= raw.dt - kTimeTolerance;
    if (!whole) raw = ins::split(navigator.previous(), raw, (end - now) / raw.dt).first;
    navigator.propagate(raw);
    navigator.set_time(whole ? mission.imu.samples[i].t : end);
    remainder.dt = 0.0;
    if (whole) epochs.push_back(navigator.nav());
    pending += raw.dt;
    if (TransitionAccumulator::substep_due(pending)) {  // the same instants as in the forward pass
      navigator.advance_sensor_states();
      pending = 0.0;
    }
  }
  return navigator.nav();
}

ForwardPass::ForwardPass(const Mission& mission, const StateLayout& layout, const FilterOptions& options, double knot_interval,
                         const FilterOutputs& outputs)
    : mission_(mission),
      layout_(layout),
      options_(options),
      outputs_(outputs),
      knot_interval_(knot_interval),
      navigator_(layout, mission.increments, mission.earth_rate),
      transition_(layout, mission.earth_rate) {
  if (mission.carrier != nullptr) tight_.emplace(*mission.carrier, layout, mission.earth_rate < 0.0);
  gate_.fill(std::numeric_limits<double>::infinity());
  if (options.gate_probability > 0.0)
    for (int dof = 1; dof <= 3; ++dof)
      gate_[static_cast<std::size_t>(dof)] = noise::chi2_upper_quantile(dof, options.gate_probability);
}

void ForwardPass::start(const FilterState& state) {
  begin({state.nav, state.x, {}}, state.P);
  if (tight_) tight_->begin(state_);
  const auto& samples = mission_.imu.samples;
  const auto after = std::upper_bound(samples.begin(), samples.end(), state.nav.t + kTimeTolerance,
                                      [](geo::GpsTime t, const record::ImuSample& s) { return t < s.t; });
  next_sample_ = static_cast<std::size_t>(after - samples.begin());
  if (after != samples.end()) {  // the start may stand inside a sample
    const double used = state.nav.t - (after->t - after->dt);
    if (used > kTimeTolerance) {
      const double left = 1.0 - used / after->dt;
      remainder_ = {left * after->dt, left * after->dtheta, left * after->dv};
    }
  }
  skip_measurements(state.nav.t - kTimeTolerance);
  knot();
  if (outputs_.epochs) outputs_.epochs({state_.nav, cov_at_start_});
}

void ForwardPass::start(const Knot& knot) {
  begin(knot.post, knot.P_post);
  if (tight_) tight_->begin(knot);
  skip_measurements(knot.post.nav.t + 2.0 * kTimeTolerance);  // those of the knot itself are used
  next_sample_ = knot.next_sample;
  remainder_ = knot.remainder;
  knot_ = knot;
  knot_.updates.clear();  // they belong to the run before
  have_knot_ = true;
}

void ForwardPass::begin(const Navigator::Start& start, const Eigen::MatrixXd& P) {
  navigator_.set(start);
  state_ = {start.nav, start.x, P};
  transition_.reset();
  cov_at_start_ = nav_covariance_n(P.topLeftCorner<kNav, kNav>(), start.nav.r_eb_e);
  last_constraint_ = start.nav.t;
  last_used_ = start.nav.t;
}

void ForwardPass::skip_measurements(geo::GpsTime before) {
  while (next_fix_ < gnss_epochs() && gnss_time(next_fix_) < before) ++next_fix_;
  const std::vector<record::MemberBlocks::Block>& blocks = mission_.imu.members.blocks;
  while (next_block_ < blocks.size() && middle(blocks[next_block_]) < before) ++next_block_;
}

std::size_t ForwardPass::gnss_epochs() const {
  return mission_.carrier != nullptr ? mission_.carrier->epochs.size() : mission_.gnss.fixes.size();
}

geo::GpsTime ForwardPass::gnss_time(std::size_t index) const {
  const geo::GpsTime t = mission_.carrier != nullptr ? mission_.carrier->epochs[index].t : mission_.gnss.fixes[index].t;
  return t - mission_.time_offset_s;
}

geo::GpsTime ForwardPass::next_knot_time(geo::GpsTime end) const {
  geo::GpsTime t = std::min(end, state_.nav.t + knot_interval_);
  if (next_fix_ < gnss_epochs()) t = std::min(t, gnss_time(next_fix_));
  const std::vector<record::MemberBlocks::Block>& blocks = mission_.imu.members.blocks;
  if (next_block_ < blocks.size()) t = std::min(t, middle(blocks[next_block_]));
  return t;
}

void ForwardPass::advance(geo::GpsTime end) {
  const auto& samples = mission_.imu.samples;
  const double first = static_cast<double>(next_sample_);
  while (next_sample_ < samples.size() && end - navigator_.nav().t > kTimeTolerance) {
    const geo::GpsTime now = navigator_.nav().t;
    const record::ImuSample& sample = samples[next_sample_];
    if (remainder_.dt == 0.0) missing_share_ = missing_share(sample.t - now);
    const ins::RawIncrement raw = increment_from(mission_.imu, next_sample_, remainder_, now);
    const geo::GpsTime knot_time = next_knot_time(end);
    const double until_knot = knot_time - now;
    if (until_knot < raw.dt - kTimeTolerance) {
      const ins::SplitIncrement parts = ins::split(navigator_.previous(), raw, until_knot / raw.dt);
      propagate(parts.first);
      remainder_ = parts.second;
      navigator_.set_time(knot_time);
      knot();
      continue;
    }
    propagate(raw);
    navigator_.set_time(sample.t);
    remainder_.dt = 0.0;
    ++next_sample_;
    if (outputs_.epochs) buffer_.push_back(navigator_.nav());
    if (until_knot <= raw.dt + kTimeTolerance) {
      knot();
      if (outputs_.progress && result_.innovations.size() % 256 == 0)
        outputs_.progress((static_cast<double>(next_sample_) - first) / (static_cast<double>(samples.size()) - first));
    }
  }
}

// Of an interval longer than a sample, the share that was not measured; jitter of the tags is none.
double ForwardPass::missing_share(double span) const {
  const double missing = span - 1.0 / mission_.imu.rate_hz;
  return missing > 0.5 / mission_.imu.rate_hz ? missing / span : 0.0;
}

void ForwardPass::propagate(const ins::RawIncrement& raw) {
  transition_.add(navigator_.propagate(raw));
  gap_ += missing_share_ * raw.dt;
  if (transition_.substep_due()) fold();
}

// The level at the middle of a fold holds for all of it.
void ForwardPass::follow_noise_level() {
  const std::vector<record::NoiseLevel>& levels = mission_.imu.noise;
  if (levels.empty()) return;
  const geo::GpsTime t = navigator_.nav().t - 0.5 * TransitionAccumulator::kSubstep;
  const std::size_t before = noise_level_;
  while (noise_level_ + 1 < levels.size() && levels[noise_level_].to <= t) ++noise_level_;
  if (noise_level_ == before && noise_level_ > 0) return;
  const auto scaled = [&](const Eigen::Vector3d& factors, const Eigen::Matrix3d& density_b) -> Eigen::Matrix3d {
    const Eigen::Matrix3d root = mission_.C_s_b * factors.cwiseSqrt().asDiagonal() * mission_.C_s_b.transpose();
    return root * density_b * root;
  };
  const record::NoiseLevel& level = levels[noise_level_];
  transition_.set_white_noise(scaled(level.gyro, layout_.gyro_density_b()), scaled(level.accel, layout_.accel_density_b()));
}

void ForwardPass::fold() {
  follow_noise_level();
  transition_.fold(navigator_.gravity_gradient());
  navigator_.advance_sensor_states();
}

void ForwardPass::add_gap_noise() {
  if (gap_ == 0.0) return;
  const double psi = kGapRateSd * gap_;
  const double v = kGapForceSd * gap_;
  state_.P.diagonal().segment<3>(kPsi).array() += psi * psi;
  state_.P.diagonal().segment<3>(kVel).array() += v * v;
  state_.P.diagonal().segment<3>(kPos).array() += 0.25 * v * v * gap_ * gap_;
  gap_ = 0.0;
}

// Brings state and covariance to the knot and completes the record of the knot before.
void ForwardPass::close_interval() {
  fold();
  transition_.propagate_covariance(state_.P);
  add_gap_noise();
  state_.nav = navigator_.nav();
  state_.x = navigator_.x();
  check_finite();
  if (outputs_.knots != nullptr && have_knot_) {
    knot_.interval = transition_.elapsed();
    knot_.Phi_n = transition_.Phi_n();
    outputs_.knots->append(knot_);
  }
  if (outputs_.epochs) emit_epochs(nav_covariance_n(state_.P.topLeftCorner<kNav, kNav>(), state_.nav.r_eb_e));
  transition_.reset();
}

void ForwardPass::knot() {
  if (have_knot_) close_interval();
  have_knot_ = true;
  knot_.updates.clear();
  knot_.slot_factors.resize(0);
  if (outputs_.at_knots) outputs_.at_knots(state_);
  C_n_e_ = geo::C_n_e(geo::geodetic_from_ecef(state_.nav.r_eb_e));  // updates move the point by metres, this by 1e-6
  while (next_fix_ < gnss_epochs() && gnss_time(next_fix_) - state_.nav.t <= kTimeTolerance) take_gnss(next_fix_++);
  const std::vector<record::MemberBlocks::Block>& blocks = mission_.imu.members.blocks;
  while (next_block_ < blocks.size() && middle(blocks[next_block_]) - state_.nav.t <= kTimeTolerance)
    member_updates(blocks[next_block_++]);
  vehicle_updates();
  navigator_.correct(state_.nav, state_.x);
  if (outputs_.epochs) cov_at_start_ = nav_covariance_n(state_.P.topLeftCorner<kNav, kNav>(), state_.nav.r_eb_e);
  if (outputs_.knots == nullptr) return;
  knot_.post = {state_.nav, state_.x, navigator_.previous()};
  knot_.P_post = state_.P;
  knot_.next_sample = next_sample_;
  knot_.remainder = remainder_;
  knot_.interval = 0.0;
  knot_.Phi_n.resize(kNav, 0);
}

FilterResult ForwardPass::finish() {
  if (transition_.elapsed() > 0.0 || !buffer_.empty()) knot();
  if (outputs_.knots != nullptr) outputs_.knots->append(knot_);
  if (outputs_.progress) outputs_.progress(1.0);
  result_.last = state_;
  return std::move(result_);
}

UpdateContext ForwardPass::context() const {
  ins::RawIncrement next = remainder_;
  if (next.dt == 0.0 && next_sample_ < mission_.imu.samples.size()) {
    const record::ImuSample& sample = mission_.imu.samples[next_sample_];
    if (missing_share(sample.t - state_.nav.t) == 0.0) next = {sample.dt, sample.dtheta, sample.dv};
  }
  return {layout_, mission_.lever_arm_b, navigator_.omega_eb_b(next), C_n_e_};
}

void ForwardPass::take_gnss(std::size_t index) {
  const geo::GpsTime t = gnss_time(index) + mission_.time_offset_s;
  const auto withheld = std::ranges::find_if(options_.withheld, [t](const Withheld& span) { return span.contains(t); });
  const bool seen = withheld == options_.withheld.end();
  if (mission_.carrier == nullptr) {
    if (seen) gnss_updates(mission_.gnss.fixes[index]);
    return;
  }
  const carrier::DifferenceEpoch& epoch = *mission_.carrier->epochs[index].differences;
  if (seen)
    carrier_updates(epoch);
  else if (withheld->satellites_left > 0)
    carrier_updates(highest(epoch, static_cast<std::size_t>(withheld->satellites_left)));
}

void ForwardPass::carrier_updates(const carrier::DifferenceEpoch& epoch) {
  const UpdateContext here = context();
  TightCoupling::Outcome outcome = tight_->update(epoch, here, state_, knot_);
  if (!outcome.contradicted) {
    gate_state_ = GateState::kClosed;
  } else if (epoch.alone && refuse()) {
    admit_doubt(epoch.alone->r_e - antenna_position(state_, here).value_e);
    outcome = tight_->update(epoch, here, state_, knot_);
  }
  result_.log_likelihood += outcome.log_likelihood;
  if (outcome.innovation) {
    last_used_ = state_.nav.t;
    result_.innovations.push_back(*outcome.innovation);
  }
}

void ForwardPass::gnss_updates(const record::GnssFix& fix) {
  record::GnssFix scaled = fix;
  const GnssScale& s = options_.gnss_scale;
  const Eigen::Vector3d scale(s.horizontal, s.horizontal, s.vertical);
  scaled.position_cov_n = scale.asDiagonal() * fix.position_cov_n * scale.asDiagonal();
  try_update(gnss_position(state_, context(), scaled), fix.quality);
  if (!options_.use_gnss_velocity || !fix.velocity) return;
  scaled.velocity->cov_n *= s.velocity * s.velocity;
  if (const auto velocity = gnss_velocity(state_, context(), scaled)) try_update(*velocity, fix.quality);
}

void ForwardPass::vehicle_updates() {
  const VehicleConstraints& vehicle = options_.vehicle;
  if (!vehicle.non_holonomic && !vehicle.zero_velocity_sd_mps) return;
  if (state_.nav.t - last_constraint_ < vehicle.interval_s - kTimeTolerance) return;
  last_constraint_ = state_.nav.t;
  bool standing = false;
  for (const TimeSpan& span : mission_.standstill) standing = standing || span.contains(state_.nav.t);
  if (standing && vehicle.zero_velocity_sd_mps)
    try_update(zero_velocity(state_, *vehicle.zero_velocity_sd_mps), record::FixQuality::kUnknown);
  if (!standing && vehicle.non_holonomic && state_.nav.v_eb_e.norm() > vehicle.min_speed_mps)
    try_update(non_holonomic(state_, context(), *vehicle.non_holonomic), record::FixQuality::kUnknown);
}

void ForwardPass::member_updates(const record::MemberBlocks::Block& block) {
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    for (std::size_t j = 1; j < block.means.size(); ++j)
      if (const auto difference = member_difference(state_, layout_, block, sensor, j))
        try_update(*difference, record::FixQuality::kUnknown);
}

void ForwardPass::try_update(const Linearised& measurement, record::FixQuality quality) {
  Innovation step = innovation(state_, measurement);
  const bool used = !gate_refuses(measurement, step.nis);
  if (used && measurement.kind == UpdateKind::kGnssPosition) {
    if (gate_state_ == GateState::kOpen && !coasting()) {
      admit_doubt(measurement.nu);
      step = innovation(state_, measurement);
    }
    last_used_ = state_.nav.t;
  }
  record_innovation(measurement, step, used, quality);
  if (!used) return;
  result_.log_likelihood += step.log_likelihood;
  AppliedUpdate applied = apply(measurement, step, state_);
  if (outputs_.knots != nullptr) knot_.updates.push_back(std::move(applied));
}

// Refusing good fixes for ever after a bad stretch is the filter's fault, not the fixes': after some patience they are taken,
// until one lies inside the gate again.
bool ForwardPass::gate_refuses(const Linearised& measurement, double nis) {
  const bool outside = nis > gate_[static_cast<std::size_t>(measurement.nu.size())];
  if (measurement.kind != UpdateKind::kGnssPosition) return outside;
  if (!outside) {
    gate_state_ = GateState::kClosed;
    return false;
  }
  return !refuse();
}

bool ForwardPass::refuse() {
  if (gate_state_ == GateState::kClosed) {
    gate_state_ = GateState::kRefusing;
    first_refused_ = state_.nav.t;
  }
  if (gate_state_ == GateState::kRefusing && state_.nav.t - first_refused_ >= options_.gate_patience_s) {
    gate_state_ = GateState::kOpen;
    result_.events.push_back({record::Event::Severity::kWarning, "gate_opened",
                              fmt::format("GNSS positions were refused for {:.1f} s without a break; from here they are taken",
                                          state_.nav.t - first_refused_),
                              state_.nav.t, 1});
  }
  return gate_state_ == GateState::kOpen;
}

// Behind an outage the filter is not confident: its drift was larger than it thought, and everything that drifted along has to
// be corrected in proportion, which an uncertainty of the position alone would prevent, in the smoother above all.
bool ForwardPass::coasting() const {
  return first_refused_ - last_used_ > options_.gate_patience_s;
}

// A fix that the filter holds for impossible is taken: the position is as uncertain as it differs, and the velocity as if it
// had come about since fixes were refused. Without this a confident filter would bend attitude and biases to explain it.
void ForwardPass::admit_doubt(const Eigen::Vector3d& nu) {
  const Eigen::Matrix3d doubt = nu * nu.transpose();
  const double since = std::max(1.0, state_.nav.t - first_refused_);
  state_.P.block<3, 3>(kPos, kPos) += doubt;
  state_.P.block<3, 3>(kVel, kVel) += doubt / (since * since);
}

void ForwardPass::record_innovation(const Linearised& m, const Innovation& step, bool used, record::FixQuality quality) {
  InnovationRecord r;
  r.t = state_.nav.t;
  r.kind = m.kind;
  r.used = used;
  r.dof = static_cast<int>(m.nu.size());
  r.nis = step.nis;
  r.quality = quality;
  if (m.kind == UpdateKind::kNonHolonomic || m.kind == UpdateKind::kMemberDifference) {
    r.nu.head(m.nu.size()) = m.nu;
    r.sd.head(m.nu.size()) = step.S.diagonal().cwiseSqrt();
  } else {
    const Eigen::Matrix3d S_n = C_n_e_.transpose() * step.S * C_n_e_;
    r.nu = C_n_e_.transpose() * m.nu;
    r.sd = S_n.diagonal().cwiseSqrt();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    r.largest_sd = std::sqrt(eigen.computeDirect(S_n, Eigen::EigenvaluesOnly).eigenvalues()(2));
  }
  result_.innovations.push_back(r);
}

void ForwardPass::emit_epochs(const record::NavCovariance& at_end) {
  const geo::GpsTime end = state_.nav.t;
  const double span = transition_.elapsed();
  for (const record::NavState& nav : buffer_) {
    const double weight = span > 0.0 ? std::clamp(1.0 - (end - nav.t) / span, 0.0, 1.0) : 1.0;
    const auto between = [weight](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
      return ((1.0 - weight) * a + weight * b).eval();
    };
    outputs_.epochs({nav,
                     {between(cov_at_start_.position, at_end.position), between(cov_at_start_.velocity, at_end.velocity),
                      between(cov_at_start_.attitude, at_end.attitude)}});
  }
  buffer_.clear();
}

void ForwardPass::check_finite() const {
  if (state_.nav.r_eb_e.allFinite() && state_.nav.v_eb_e.allFinite() && state_.nav.q_b_e.coeffs().allFinite() &&
      state_.P.diagonal().allFinite() && state_.P.diagonal().minCoeff() >= 0.0)
    return;
  throw NumericalError("navigation state is not finite or its covariance not positive", geo::to_string(state_.nav.t),
                       "likely causes: wrong axes or sign of gravity, increments taken for rates, a gap in the IMU data");
}

}  // namespace coast::estimate
