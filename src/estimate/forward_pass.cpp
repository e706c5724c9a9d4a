#include "forward_pass.hpp"
#include "antenna.hpp"
#include "measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"

namespace coast::estimate {

namespace {

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
      next_aid_(mission.aids.size(), 0),
      member_counts_(layout.members().size()),
      aid_counts_(mission.aids.size()) {
  if (outputs.closed_knots) propagation_.split_white_noise();
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
  if (after != samples.end()) {  // the start may be inside a sample
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
  knot_.updates.clear();  // they belong to the earlier run
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
  for (std::size_t a = 0; a < next_aid_.size(); ++a) {
    const std::vector<record::AidSample>& samples = *mission_.aids[a].samples;
    next_aid_[a] =
        static_cast<std::size_t>(std::ranges::lower_bound(samples, before, {}, &record::AidSample::t) - samples.begin());
  }
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
  for (std::size_t a = 0; a < next_aid_.size(); ++a)
    if (next_aid_[a] < mission_.aids[a].samples->size()) t = std::min(t, aid_time(a));
  if (next_stop_ < options_.knots_at.size()) t = std::min(t, options_.knots_at[next_stop_]);
  if (next_restart_ < mission_.restarts.size()) t = std::min(t, mission_.restarts[next_restart_].nav.t);
  return t;
}

geo::GpsTime ForwardPass::aid_time(std::size_t aid) const {
  return (*mission_.aids[aid].samples)[next_aid_[aid]].t;
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

// Propagates state and covariance to the knot and completes the record of the previous one.
void ForwardPass::close_interval() {
  propagation_.close(state_.P);
  state_.nav = propagation_.navigator().nav();
  state_.x = propagation_.navigator().x();
  check_finite();
  if (keeps_knots() && have_knot_) {
    knot_.interval = propagation_.elapsed();
    knot_.renews_gnss_error = propagation_.renewed_gnss_error();
    knot_.Phi_n = propagation_.Phi_n();
    deliver_knot();
  }
  if (outputs_.epochs) emit_epochs(nav_covariance_n(state_.P.topLeftCorner<kNav, kNav>(), state_.nav.r_eb_e));
}

void ForwardPass::deliver_knot() {
  if (outputs_.knots != nullptr) outputs_.knots->append(knot_);
  if (outputs_.closed_knots) outputs_.closed_knots(knot_, propagation_.Q_axes());
}

void ForwardPass::knot() {
  if (have_knot_) close_interval();
  have_knot_ = true;
  knot_.updates.clear();
  knot_.slot_factors.resize(0);
  if (outputs_.at_knots) outputs_.at_knots(state_);
  C_n_e_ = geo::C_n_e(geo::geodetic_from_ecef(state_.nav.r_eb_e));  // updates move the point by metres, this by 1e-6
  hold_heading();
  while (next_fix_ < gnss_epochs() && gnss_time(next_fix_) - state_.nav.t <= kTimeTolerance) take_gnss(next_fix_++);
  const std::vector<record::MemberBlocks::Block>& blocks = member_blocks();
  while (next_block_ < blocks.size() && middle(blocks[next_block_]) - state_.nav.t <= kTimeTolerance)
    member_updates(next_block_++);
  aid_updates();
  while (next_stop_ < options_.knots_at.size() && options_.knots_at[next_stop_] - state_.nav.t <= kTimeTolerance) ++next_stop_;
  while (next_restart_ < mission_.restarts.size() && mission_.restarts[next_restart_].nav.t - state_.nav.t <= kTimeTolerance)
    ++next_restart_;
  vehicle_updates();
  standing_ = stands_still() ? std::optional(state_.nav) : std::nullopt;
  propagation_.correct(state_.nav, state_.x);
  if (outputs_.epochs) cov_at_start_ = nav_covariance_n(state_.P.topLeftCorner<kNav, kNav>(), state_.nav.r_eb_e);
  if (!keeps_knots()) return;
  knot_.post = {state_.nav, state_.x, propagation_.navigator().previous()};
  knot_.P_post = state_.P;
  knot_.next_sample = cursor_.next_sample;
  knot_.remainder = cursor_.remainder;
  knot_.interval = 0.0;
  knot_.renews_gnss_error = false;
  knot_.Phi_n.resize(kNav, 0);
}

FilterResult ForwardPass::finish() {
  if (propagation_.elapsed() > 0.0 || !buffer_.empty()) knot();
  if (keeps_knots()) deliver_knot();
  if (outputs_.progress) outputs_.progress(1.0);
  note_refused_members();
  note_refused_aids();
  result_.last = state_;
  return std::move(result_);
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
