#include "forward_pass.hpp"
#include "antenna.hpp"
#include "measurement.hpp"

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

ForwardPass::ForwardPass(const Mission& mission, const StateLayout& layout, const FilterOptions& options, double knot_interval,
                         const FilterOutputs& outputs)
    : mission_(mission),
      layout_(layout),
      options_(options),
      outputs_(outputs),
      knot_interval_(knot_interval),
      propagation_(mission, layout),
      member_counts_(layout.members().size()) {
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
  cursor_.next_sample = static_cast<std::size_t>(after - samples.begin());
  if (after != samples.end()) {  // the start may stand inside a sample
    const double used = state.nav.t - (after->t - after->dt);
    if (used > kTimeTolerance) {
      const double left = 1.0 - used / after->dt;
      cursor_.remainder = {left * after->dt, left * after->dtheta, left * after->dv};
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
  cursor_ = {knot.next_sample, knot.remainder};
  knot_ = knot;
  knot_.updates.clear();  // they belong to the run before
  have_knot_ = true;
}

void ForwardPass::begin(const Navigator::Start& start, const Eigen::MatrixXd& P) {
  propagation_.set(start);
  state_ = {start.nav, start.x, P};
  cov_at_start_ = nav_covariance_n(P.topLeftCorner<kNav, kNav>(), start.nav.r_eb_e);
  last_constraint_ = start.nav.t;
  last_used_ = start.nav.t;
}

void ForwardPass::skip_measurements(geo::GpsTime before) {
  while (next_fix_ < gnss_epochs() && gnss_time(next_fix_) < before) ++next_fix_;
  const std::vector<record::MemberBlocks::Block>& blocks = member_blocks();
  while (next_block_ < blocks.size() && middle(blocks[next_block_]) < before) ++next_block_;
  while (next_stop_ < options_.knots_at.size() && options_.knots_at[next_stop_] < before) ++next_stop_;
  while (next_restart_ < mission_.restarts.size() && mission_.restarts[next_restart_].nav.t < before) ++next_restart_;
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
  const std::vector<record::MemberBlocks::Block>& blocks = member_blocks();
  if (next_block_ < blocks.size()) t = std::min(t, middle(blocks[next_block_]));
  if (next_stop_ < options_.knots_at.size()) t = std::min(t, options_.knots_at[next_stop_]);
  if (next_restart_ < mission_.restarts.size()) t = std::min(t, mission_.restarts[next_restart_].nav.t);
  return t;
}

void ForwardPass::advance(geo::GpsTime end) {
  const std::size_t samples = mission_.imu.samples.size();
  const double first = static_cast<double>(cursor_.next_sample);
  const Navigator& navigator = propagation_.navigator();
  while (cursor_.next_sample < samples && end - navigator.nav().t > kTimeTolerance) {
    const geo::GpsTime knot_time = next_knot_time(end);
    walk(mission_.imu, cursor_, knot_time, navigator, [&](const SampleStep& step) {
      propagation_.step(step);
      if (outputs_.epochs && step.whole) buffer_.push_back(navigator.nav());
    });
    if (knot_time - navigator.nav().t > kTimeTolerance) return;  // the recording has ended
    knot();
    if (outputs_.progress && result_.innovations.size() % 256 == 0)
      outputs_.progress((static_cast<double>(cursor_.next_sample) - first) / (static_cast<double>(samples) - first));
  }
}

// Brings state and covariance to the knot and completes the record of the knot before.
void ForwardPass::close_interval() {
  propagation_.close(state_.P);
  state_.nav = propagation_.navigator().nav();
  state_.x = propagation_.navigator().x();
  check_finite();
  if (keeps_knots() && have_knot_) {
    knot_.interval = propagation_.elapsed();
    knot_.Phi_n = propagation_.Phi_n();
    deliver_knot();
  }
  if (outputs_.epochs) emit_epochs(nav_covariance_n(state_.P.topLeftCorner<kNav, kNav>(), state_.nav.r_eb_e));
}

void ForwardPass::deliver_knot() {
  if (outputs_.knots != nullptr) outputs_.knots->append(knot_);
  if (outputs_.closed_knots) outputs_.closed_knots(knot_, propagation_.white_noise());
}

void ForwardPass::knot() {
  if (have_knot_) close_interval();
  have_knot_ = true;
  knot_.updates.clear();
  knot_.slot_factors.resize(0);
  if (outputs_.at_knots) outputs_.at_knots(state_);
  C_n_e_ = geo::C_n_e(geo::geodetic_from_ecef(state_.nav.r_eb_e));  // updates move the point by metres, this by 1e-6
  while (next_fix_ < gnss_epochs() && gnss_time(next_fix_) - state_.nav.t <= kTimeTolerance) take_gnss(next_fix_++);
  const std::vector<record::MemberBlocks::Block>& blocks = member_blocks();
  while (next_block_ < blocks.size() && middle(blocks[next_block_]) - state_.nav.t <= kTimeTolerance)
    member_updates(next_block_++);
  while (next_stop_ < options_.knots_at.size() && options_.knots_at[next_stop_] - state_.nav.t <= kTimeTolerance) ++next_stop_;
  while (next_restart_ < mission_.restarts.size() && mission_.restarts[next_restart_].nav.t - state_.nav.t <= kTimeTolerance)
    ++next_restart_;
  vehicle_updates();
  propagation_.correct(state_.nav, state_.x);
  if (outputs_.epochs) cov_at_start_ = nav_covariance_n(state_.P.topLeftCorner<kNav, kNav>(), state_.nav.r_eb_e);
  if (!keeps_knots()) return;
  knot_.post = {state_.nav, state_.x, propagation_.navigator().previous()};
  knot_.P_post = state_.P;
  knot_.next_sample = cursor_.next_sample;
  knot_.remainder = cursor_.remainder;
  knot_.interval = 0.0;
  knot_.Phi_n.resize(kNav, 0);
}

FilterResult ForwardPass::finish() {
  if (propagation_.elapsed() > 0.0 || !buffer_.empty()) knot();
  if (keeps_knots()) deliver_knot();
  if (outputs_.progress) outputs_.progress(1.0);
  note_refused_members();
  result_.last = state_;
  return std::move(result_);
}

UpdateContext ForwardPass::context() const {
  return update_context(mission_, layout_, cursor_, propagation_.navigator(), C_n_e_);
}

void ForwardPass::take_gnss(std::size_t index) {
  const geo::GpsTime t = gnss_time(index) + mission_.time_offset_s;
  const auto withheld = std::ranges::find_if(options_.withheld, [t](const Withheld& span) { return span.contains(t); });
  const bool seen = withheld == options_.withheld.end();
  if (mission_.carrier == nullptr) {
    if (seen) gnss_updates(index);
    return;
  }
  const carrier::DifferenceEpoch& epoch = *mission_.carrier->epochs[index].differences;
  if (seen)
    carrier_updates(epoch);
  else if (withheld->satellites_left > 0)
    carrier_updates(highest(epoch, static_cast<std::size_t>(withheld->satellites_left)));
}

std::optional<Eigen::Vector3d> ForwardPass::seen_alone(const carrier::DifferenceEpoch& epoch, const UpdateContext& here) const {
  if (!epoch.alone) return std::nullopt;
  return epoch.alone->r_e - antenna_position(state_, here).value_e;
}

void ForwardPass::carrier_updates(const carrier::DifferenceEpoch& epoch) {
  const UpdateContext here = context();
  TightCoupling::Outcome outcome = tight_->update(epoch, here, state_, knot_);
  if (!outcome.contradicted) {
    gate_state_ = GateState::kClosed;
  } else if (const auto nu = seen_alone(epoch, here); nu && refuse(*nu)) {
    admit_doubt(*nu);
    outcome = tight_->update(epoch, here, state_, knot_);
  }
  result_.log_likelihood += outcome.log_likelihood;
  if (outcome.innovation) {
    last_used_ = state_.nav.t;
    result_.innovations.push_back(*outcome.innovation);
  }
}

void ForwardPass::gnss_updates(std::size_t index) {
  const record::FixQuality quality = mission_.gnss.fixes[index].quality;
  try_update({UpdateKind::kGnssPosition, index}, quality);
  if (options_.use_gnss_velocity) try_update({UpdateKind::kGnssVelocity, index}, quality);
}

void ForwardPass::vehicle_updates() {
  const VehicleConstraints& vehicle = options_.vehicle;
  if (!vehicle.non_holonomic && !vehicle.zero_velocity_sd_mps) return;
  if (state_.nav.t - last_constraint_ < vehicle.interval_s - kTimeTolerance) return;
  last_constraint_ = state_.nav.t;
  bool standing = false;
  for (const TimeSpan& span : mission_.standstill) standing = standing || span.contains(state_.nav.t);
  if (standing && vehicle.zero_velocity_sd_mps) try_update({UpdateKind::kZeroVelocity});
  if (!standing && vehicle.non_holonomic && state_.nav.v_eb_e.norm() > vehicle.min_speed_mps)
    try_update({UpdateKind::kNonHolonomic});
}

const std::vector<record::MemberBlocks::Block>& ForwardPass::member_blocks() const {
  static const std::vector<record::MemberBlocks::Block> none;
  return layout_.members().empty() ? none : mission_.imu.members.blocks;
}

void ForwardPass::member_updates(std::size_t index) {
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel}) {
    Measurement difference{UpdateKind::kMemberDifference, index, sensor, 1, {}};
    for (; difference.member < mission_.imu.members.names.size(); ++difference.member) {
      const std::optional<bool> used = try_update(difference);
      if (!used) continue;
      MemberCount& count = member_counts_[difference.member];
      ++count.met;
      if (*used) continue;
      ++count.refused;
      difference.left_out.push_back(difference.member);  // those behind are not compared with it
    }
  }
}

// A member that is nothing like its error model stays so, and nobody would see it.
void ForwardPass::note_refused_members() {
  constexpr double kMany = 0.05;
  for (std::size_t j = 0; j < member_counts_.size(); ++j) {
    const MemberCount& count = member_counts_[j];
    if (static_cast<double>(count.refused) <= kMany * static_cast<double>(count.met)) continue;
    result_.events.push_back(
        {record::Event::Severity::kWarning, "member_refused",
         fmt::format("{} of {} differences of {} from the members before it were refused: its error model, or "
                     "one of theirs, is not what they do",
                     count.refused, count.met, layout_.members()[j].name),
         state_.nav.t, static_cast<long>(count.refused)});
  }
}

std::optional<bool> ForwardPass::try_update(const Measurement& what, record::FixQuality quality) {
  const std::optional<Linearised> measurement = linearise(what, mission_, options_, state_, context());
  if (!measurement) return std::nullopt;
  Innovation step = innovation(state_, *measurement);
  const bool used = !gate_refuses(*measurement, step.nis);
  if (outputs_.measurements) outputs_.measurements(what, used);
  if (used && measurement->kind == UpdateKind::kGnssPosition) {
    if (gate_state_ == GateState::kOpen && !coasting()) {
      admit_doubt(measurement->nu);
      step = innovation(state_, *measurement);
    }
    last_used_ = state_.nav.t;
  }
  record_innovation(*measurement, step, used, quality);
  if (!used) return false;
  result_.log_likelihood += step.log_likelihood;
  AppliedUpdate applied = apply(*measurement, step, state_);
  if (keeps_knots()) knot_.updates.push_back(std::move(applied));
  return true;
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
  return !refuse(measurement.nu);
}

bool ForwardPass::refuse(const Eigen::Vector3d& nu_e) {
  if (gate_state_ == GateState::kClosed) {
    gate_state_ = GateState::kRefusing;
    first_refused_ = state_.nav.t;
  }
  if (gate_state_ == GateState::kRefusing && state_.nav.t - first_refused_ >= options_.gate_patience_s) {
    gate_state_ = GateState::kOpen;
    note_opened(C_n_e_.transpose() * nu_e);
  }
  return gate_state_ == GateState::kOpen;
}

// Fixes that come all along and differ from one instant on have jumped; behind an outage it is the filter that has drifted.
void ForwardPass::note_opened(const Eigen::Vector3d& nu_n) {
  const std::string by =
      fmt::format("{:.2f} m ({:+.2f} north, {:+.2f} east, {:+.2f} up)", nu_n.norm(), nu_n.x(), nu_n.y(), -nu_n.z());
  if (coasting()) {
    result_.events.push_back({record::Event::Severity::kWarning, "gate_opened",
                              fmt::format("GNSS positions behind an outage differ by {} from the filter's, which drifted more "
                                          "than it thought; after {:.1f} s they are taken",
                                          by, state_.nav.t - first_refused_),
                              state_.nav.t, 1});
  } else {
    result_.jumps.push_back({first_refused_, nu_n});
    result_.events.push_back(
        {record::Event::Severity::kWarning, "gnss_jump",
         fmt::format("GNSS positions jumped by {} at {:.1f} s of week and stayed there. They were refused "
                     "for {:.1f} s and are followed from there on; either side of the jump may be the wrong one",
                     by, first_refused_.sow(), state_.nav.t - first_refused_),
         first_refused_, 1});
  }
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
  const double span = propagation_.elapsed();
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
