#include "coast/estimate/forward_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coast/geo/earth.hpp"
#include "coast/record/error.hpp"
#include "forward_pass.hpp"

namespace coast::estimate {

ins::RawIncrement increment_from(const record::ImuRecording& imu, std::size_t index, const ins::RawIncrement& remainder,
                                 geo::GpsTime now) {
  const record::ImuSample& sample = imu.samples[index];
  ins::RawIncrement raw = remainder.dt > 0.0 ? remainder : ins::RawIncrement{sample.dt, sample.dtheta, sample.dv};
  const double span = sample.t - now;
  const double stretch = span / raw.dt;
  if (std::abs(span - raw.dt) > kTimeTolerance) raw = {span, stretch * raw.dtheta, stretch * raw.dv};
  return raw;
}

namespace {

AuxiliaryStates with_those_of(const Mission& mission, AuxiliaryStates auxiliary) {
  if (mission.carrier != nullptr) auxiliary.carrier_slots = static_cast<int>(mission.carrier->most_unknowns);
  for (const AidStream& stream : mission.aids) auxiliary.aids.push_back({stream.name, stream.aid->states()});
  return auxiliary;
}

void check_members(const record::MemberBlocks& recorded, const StateLayout& layout) {
  if (recorded.names.empty() || layout.members().empty()) return;  // a model of the sum only does not use them
  std::vector<std::string> names;
  bool noisy = true;
  for (const StateLayout::Member& member : layout.members()) {
    names.push_back(member.name);
    noisy = noisy && member.gyro_density.minCoeff() > 0.0 && member.accel_density.minCoeff() > 0.0;
  }
  if (names != recorded.names)
    throw InputError({recorded.source, 0, fmt::format("members {}", fmt::join(recorded.names, ", ")),
                      fmt::format("those that the error model has shares of, in their order: {}", fmt::join(names, ", ")),
                      "Both files come from one run of `coast synth`."});
  if (!noisy)
    throw InputError({recorded.source, 0, "members without white noise in the error model", "white noise on every axis of each",
                      "Without it their differences would be exact."});
}

}  // namespace

ForwardFilter::ForwardFilter(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options)
    : mission_(mission), options_(options), layout_(model, mission.C_s_b, with_those_of(mission, options.auxiliary)) {
  if (!(options.knot_interval_s > 0.0)) throw std::invalid_argument("FilterOptions::knot_interval_s must be above zero");
  check_members(mission.imu.members, layout_);
  // A restart within an outage uses data that the outage withholds.
  std::erase_if(mission_.restarts, [&](const Restart& restart) {
    const geo::GpsTime tagged = restart.nav.t + mission.time_offset_s;
    return std::ranges::any_of(options.withheld, [&](const Withheld& span) { return span.contains(tagged); });
  });
  // The closed form for the effect of driving noise on the navigation states within an interval requires short intervals.
  knot_interval_ = std::min(options.knot_interval_s, std::max(0.2 * layout_.shortest_time(), 2.0 / mission.imu.rate_hz));
}

FilterState ForwardFilter::initial_state(const record::NavState& nav, const Eigen::Vector3d& sd_position_n,
                                         const Eigen::Vector3d& sd_velocity_n, const Eigen::Vector3d& sd_attitude_n) const {
  FilterState state;
  state.nav = nav;
  const std::vector<record::ImuSample>& samples = mission_.imu.samples;
  const geo::GpsTime begin = samples.empty() ? nav.t : samples.front().t - samples.front().dt;
  state.x = layout_.mean(nav.t - mission_.first_epoch.value_or(begin));
  state.P = layout_.initial_covariance();
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e));
  const auto rotated = [&](const Eigen::Vector3d& sd) {
    return (C_n_e * sd.cwiseAbs2().asDiagonal() * C_n_e.transpose()).eval();
  };
  state.P.block<3, 3>(kPos, kPos) = rotated(sd_position_n);
  state.P.block<3, 3>(kVel, kVel) = rotated(sd_velocity_n);
  state.P.block<3, 3>(kPsi, kPsi) = rotated(sd_attitude_n);
  return state;
}

FilterResult ForwardFilter::run(const FilterState& start, const FilterOutputs& outputs) const {
  return run_until(start, mission_.imu.samples.back().t, outputs);
}

FilterResult ForwardFilter::run_until(const FilterState& start, geo::GpsTime end, const FilterOutputs& outputs) const {
  ForwardPass pass(mission_, layout_, options_, knot_interval_, outputs);
  pass.start(start);
  pass.advance(std::min(end, mission_.imu.samples.back().t));
  return pass.finish();
}

FilterResult ForwardFilter::resume(const Knot& knot, geo::GpsTime end, const FilterOutputs& outputs) const {
  ForwardPass pass(mission_, layout_, options_, knot_interval_, outputs);
  pass.start(knot);
  pass.advance(std::min(end, mission_.imu.samples.back().t));
  return pass.finish();
}

}  // namespace coast::estimate
