// Measurements at a knot in the forward pass: which are tried, rejected, recorded.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "antenna.hpp"
#include "coast/geo/earth.hpp"
#include "forward_pass.hpp"
#include "measurement.hpp"

namespace coast::estimate {

namespace {

/// An epoch reduced to its highest satellites.
carrier::DifferenceEpoch highest(carrier::DifferenceEpoch epoch, std::size_t satellites) {
  std::ranges::sort(epoch.satellites, std::greater{}, &carrier::SatelliteDifference::base_elevation);
  if (epoch.satellites.size() > satellites)
    epoch.satellites.erase(epoch.satellites.begin() + static_cast<std::ptrdiff_t>(satellites), epoch.satellites.end());
  epoch.alone.reset();
  return epoch;
}

}  // namespace

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
  const bool standing =
      std::ranges::any_of(mission_.standstill, [t = state_.nav.t](const TimeSpan& s) { return s.contains(t); });
  if (standing && vehicle.zero_velocity_sd_mps) try_update({UpdateKind::kZeroVelocity});
  if (!standing && vehicle.non_holonomic && state_.nav.v_eb_e.norm() > vehicle.min_speed_mps)
    try_update({UpdateKind::kNonHolonomic});
}

// Before the other updates of a knot: its noise is that of the interval which ends there.
void ForwardPass::hold_heading() {
  if (!options_.vehicle.heading_hold_sd || !standing_ || restart_at(mission_, state_.nav.t) != nullptr) return;
  const RestInterval interval{standing_->q_b_e, propagation_.elapsed(), propagation_.Phi_n().middleRows<3>(kPsi),
                              propagation_.Q_gyro().middleCols<3>(kPsi)};
  const Linearised measurement = heading_hold(state_, context(), interval, *options_.vehicle.heading_hold_sd);
  static_cast<void>(take({UpdateKind::kHeadingHold}, measurement, record::FixQuality::kUnknown));
}

// A standstill found in the samples may begin and end with a little motion.
bool ForwardPass::stands_still() const {
  constexpr double kMargin = 0.5;  // s
  return std::ranges::any_of(mission_.standstill, [t = state_.nav.t](const TimeSpan& span) {
    return span.from + kMargin <= t && t < span.to - kMargin;
  });
}

void ForwardPass::aid_updates() {
  for (std::size_t a = 0; a < next_aid_.size(); ++a) {
    while (next_aid_[a] < mission_.aids[a].samples->size() && aid_time(a) - state_.nav.t <= kTimeTolerance) {
      Measurement sample{UpdateKind::kAid, next_aid_[a]++};
      sample.aid = a;
      const std::optional<bool> used = try_update(sample);
      if (!used) continue;
      ++aid_counts_[a].met;
      if (!*used) ++aid_counts_[a].refused;
    }
  }
}

void ForwardPass::note_refused_aids() {
  constexpr double kMany = 0.05;
  for (std::size_t a = 0; a < aid_counts_.size(); ++a) {
    const Count& count = aid_counts_[a];
    if (static_cast<double>(count.refused) <= kMany * static_cast<double>(count.met)) continue;
    result_.events.push_back({record::Event::Severity::kWarning, "aid_refused",
                              fmt::format("{} of {} samples of the {} contradict the other measurements and were refused: its "
                                          "times, unit, mounting or sigma are not what the run file says",
                                          count.refused, count.met, mission_.aids[a].name),
                              state_.nav.t, static_cast<long>(count.refused)});
  }
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
      Count& count = member_counts_[difference.member];
      ++count.met;
      if (*used) continue;
      ++count.refused;
      difference.left_out.push_back(difference.member);  // later members are not compared with it
    }
  }
}

// A member that contradicts its error model usually continues to do so, which would otherwise not be noticed.
void ForwardPass::note_refused_members() {
  constexpr double kMany = 0.05;
  for (std::size_t j = 0; j < member_counts_.size(); ++j) {
    const Count& count = member_counts_[j];
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
  const bool used = take(what, *measurement, quality);
  if (outputs_.measurements) outputs_.measurements(what, used);
  return used;
}

bool ForwardPass::take(const Measurement& what, const Linearised& measurement, record::FixQuality quality) {
  Innovation step = innovation(state_, measurement);
  const bool used = !gate_refuses(measurement, step.nis);
  if (used && measurement.kind == UpdateKind::kGnssPosition) {
    if (gate_state_ == GateState::kOpen && !coasting()) {
      admit_doubt(measurement.nu);
      step = innovation(state_, measurement);
    }
    last_used_ = state_.nav.t;
  }
  record_innovation(what, measurement, step, used, quality);
  if (!used) return false;
  result_.log_likelihood += step.log_likelihood;
  AppliedUpdate applied = apply(measurement, step, state_);
  if (keeps_knots()) knot_.updates.push_back(std::move(applied));
  return true;
}

// If good fixes are rejected without end after a bad stretch, the filter is wrong, not the fixes: after some time they are
// used, until one is inside the gate again.
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

// Uninterrupted fixes that differ from some instant on have jumped; after an outage the filter has drifted.
void ForwardPass::note_opened(const Eigen::Vector3d& nu_n) {
  const std::string by =
      fmt::format("{:.2f} m ({:+.2f} north, {:+.2f} east, {:+.2f} up)", nu_n.norm(), nu_n.x(), nu_n.y(), -nu_n.z());
  if (coasting()) {
    result_.events.push_back(
        {record::Event::Severity::kWarning, "gate_opened",
         fmt::format("After an outage GNSS positions differ by {} from the filter, whose drift exceeded its "
                     "sigma; they are used again after {:.1f} s",
                     by, state_.nav.t - first_refused_),
         state_.nav.t, 1});
  } else {
    result_.jumps.push_back({first_refused_, nu_n});
    result_.events.push_back(
        {record::Event::Severity::kWarning, "gnss_jump",
         fmt::format("GNSS positions jumped by {} at {:.1f} s of week and stayed there. They were refused "
                     "for {:.1f} s, then used; the wrong positions may be those before the jump or those after it",
                     by, first_refused_.sow(), state_.nav.t - first_refused_),
         first_refused_, 1});
  }
}

// After an outage the drift exceeded its sigma. Velocity, attitude and biases drifted with the position and are to be corrected
// in proportion; a larger variance of the position alone would prevent that, above all in the smoother.
bool ForwardPass::coasting() const {
  return first_refused_ - last_used_ > options_.gate_patience_s;
}

// A fix that the filter considers impossible is used: the position's sigma is enlarged by the difference, the velocity's by
// this over the time of rejection. Otherwise an overconfident filter would change attitude and biases to explain it.
void ForwardPass::admit_doubt(const Eigen::Vector3d& nu) {
  const Eigen::Matrix3d doubt = nu * nu.transpose();
  const double since = std::max(1.0, state_.nav.t - first_refused_);
  state_.P.block<3, 3>(kPos, kPos) += doubt;
  state_.P.block<3, 3>(kVel, kVel) += doubt / (since * since);
}

void ForwardPass::record_innovation(const Measurement& what, const Linearised& m, const Innovation& step, bool used,
                                    record::FixQuality quality) {
  InnovationRecord r;
  r.t = state_.nav.t;
  r.kind = m.kind;
  r.aid = what.aid;
  r.used = used;
  r.dof = static_cast<int>(m.nu.size());
  r.nis = step.nis;
  r.quality = quality;
  const bool in_own_axes = m.kind == UpdateKind::kNonHolonomic || m.kind == UpdateKind::kMemberDifference ||
                           m.kind == UpdateKind::kHeadingHold || m.kind == UpdateKind::kAid;
  if (in_own_axes) {
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

}  // namespace coast::estimate
