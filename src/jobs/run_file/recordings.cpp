#include "run_file/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "coast/geo/leap_seconds.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/io/inspect.hpp"
#include "coast/io/member_blocks.hpp"
#include "coast/io/noise_levels.hpp"
#include "coast/record/error.hpp"
#include "common/tell.hpp"
#include "run_file/run_events.hpp"

namespace coast::jobs {

namespace {

// Future leap seconds are unknown: after the end of the table a file in UTC may be wrong by a second.
void check_leap_seconds(const io::TimeOptions& time, const std::string& source, geo::GpsTime last, record::Events& events) {
  const geo::GpsTime expiry = geo::leap_second_table().expiry;
  if ((time.kind != io::TimeKind::kUtc && time.kind != io::TimeKind::kUnix) || last <= expiry) return;
  events.push_back(
      {record::Event::Severity::kWarning, "leap_seconds_expired",
       fmt::format("{}: times in UTC, and this machine's leap seconds are known until {} only: should one have been "
                   "inserted since, every time is a second off. Install newer time-zone data (tzdata).",
                   source, geo::to_string(expiry)),
       std::nullopt, 1});
}

// Positions from the rover's and the base's observations; their events are reported like all others.
void read_with_ppk(const RunConfig& config, const Progress& progress, Recordings& recordings) {
  PpkResult ppk =
      jobs::ppk(*config.ppk, {[&progress](const char*, double share) { progress("solving GNSS positions", share); }, {}, {}});
  recordings.gnss = ppk.fixes;
  recordings.gnss.events = ppk.events;
  recordings.inspection = ppk_sentences(ppk);
  if (recordings.gnss.fixes.empty())
    throw InputError({config.ppk->rover.string(), 0, "no epoch with a position", "codes of four satellites or more",
                      "Run `coast ppk` on it: its page says what is missing."});
  recordings.imu = io::read_imu(config.imu, recordings.gnss.fixes.front().t);
  if (!config.tight) return;
  recordings.inspection.emplace_back("GNSS: tightly coupled, observations go into the filter in place of positions");
  recordings.carrier = std::make_shared<const estimate::CarrierObservations>(
      estimate::carrier_observations(std::move(ppk.solution), ppk.options));
}

}  // namespace

Recordings load(const RunConfig& config, const Progress& progress) {
  progress("reading", 0.0);
  Recordings recordings;
  if (config.ppk) {
    read_with_ppk(config, progress, recordings);
  } else if (config.gnss.time.lacks_week() && !config.imu.time.lacks_week()) {
    recordings.imu = io::read_imu(config.imu);
    recordings.gnss = io::read_gnss(config.gnss, recordings.imu.samples.front().t);
  } else {
    recordings.gnss = io::read_gnss(config.gnss);
    recordings.imu = io::read_imu(config.imu, recordings.gnss.fixes.front().t);
  }
  if (config.noise_levels) recordings.imu.noise = io::read_noise_levels(*config.noise_levels);
  if (config.members) recordings.imu.members = io::read_member_blocks(*config.members, config.setup.model.members());
  if (config.calibration) {
    record::take_out(*config.calibration, recordings.imu);
    recordings.inspection.push_back(
        fmt::format("IMU: scale, misalignment and bias by the calibration of {} are taken out", config.calibration->sensor));
  }
  ins::to_body(recordings.imu, config.setup.C_s_b);
  io::Inspection inspection = io::inspect(recordings.imu, recordings.gnss);
  std::ranges::move(inspection.sentences, std::back_inserter(recordings.inspection));
  recordings.inspection_events = std::move(inspection.events);
  recordings.time_shift_s = inspection.time_shift_s;
  check_leap_seconds(config.imu.time, recordings.imu.source, recordings.imu.samples.back().t, recordings.inspection_events);
  check_leap_seconds(config.gnss.time, recordings.gnss.source, recordings.gnss.fixes.back().t, recordings.inspection_events);
  for (const AidConfig& aid : config.aids) recordings.aids.push_back(io::read_aid(aid.file, recordings.imu.samples.front().t));
  if (config.reference) recordings.reference = io::read_reference(*config.reference, recordings.imu.samples.front().t);
  if (config.events) recordings.marks = read_named_marks(*config.events, recordings.imu.samples.front().t);
  return recordings;
}

void tell_inspection(const Recordings& recordings, const Progress& progress) {
  for (const std::string& sentence : recordings.inspection)
    if (progress.say) progress.say(sentence);
  tell_warnings(recordings.imu.events, progress);
  tell_warnings(recordings.gnss.events, progress);
  for (const record::AidRecording& aid : recordings.aids) tell_warnings(aid.events, progress);
  if (recordings.reference) tell_warnings(recordings.reference->events, progress);
  if (recordings.marks) tell_warnings(recordings.marks->events, progress);
  tell_warnings(recordings.inspection_events, progress);
}

namespace {

ins::InitialState start_of(const GivenStart& start, geo::GpsTime near) {
  ins::InitialState state;
  state.nav.t = geo::GpsTime::from_week(near.week(), start.time_s);
  state.nav.r_eb_e = geo::ecef_from_geodetic(start.position);
  const Eigen::Matrix3d C_n_e = geo::C_n_e(start.position);
  state.nav.v_eb_e = C_n_e * start.velocity_n;
  state.nav.q_b_e = Eigen::Quaterniond(C_n_e * geo::dcm_from_euler(start.attitude));
  state.sd_position_n = start.sd_position_n;
  state.sd_velocity_n = start.sd_velocity_n;
  state.sd_attitude_n = start.sd_attitude_n;
  state.method = "given in the configuration";
  return state;
}

}  // namespace

study::Setup setup_of(const RunConfig& config, const Recordings& recordings, const std::optional<study::OutageSweep>& sweep) {
  study::Setup setup = config.setup;
  setup.unstated = {};  // only `process` tests what is not stated: outages and diagnoses compare stated models
  setup.carrier = recordings.carrier;
  for (std::size_t i = 0; i < config.aids.size(); ++i)
    setup.aids.push_back({config.aids[i].name, config.aids[i].aid, recordings.aids[i]});
  const geo::GpsTime first_fix = recordings.gnss.fixes.front().t;
  if (config.start) setup.start = start_of(*config.start, first_fix);
  const auto studied_from = [&setup](geo::GpsTime t) {
    if (!setup.refine_before || t < *setup.refine_before) setup.refine_before = t;
  };
  for (const OutageSeconds& outage : config.outages) studied_from(geo::GpsTime::from_week(first_fix.week(), outage.start_s));
  if (sweep) studied_from(std::max(first_fix, recordings.imu.samples.front().t) + sweep->first_s);
  return setup;
}

void refuse_wrong_axes(const RunConfig& config, const Recordings& recordings) {
  if (config.accept) return;
  for (const record::Event& event : recordings.inspection_events)
    if (event.kind == "gravity_sign" || event.kind == "gravity_axis" || (event.kind == "gyro_sign" && !config.tight))
      throw NumericalError("the axes contradict gravity or the course", "",
                           event.text + " (`accept: true` goes on all the same)");
}

void refuse_wrong_units(const RunConfig& config, const Recordings& recordings) {
  if (config.accept) return;
  for (const record::Event& event : recordings.inspection_events)
    if (event.kind == "gyro_unit" || event.kind == "specific_force_unit")
      throw NumericalError("the units contradict gravity or the course", "",
                           event.text + " (`accept: true` goes on all the same)");
}

void take_out_effects(const RunConfig& config, Recordings& recordings, study::Setup& setup, const Progress& progress) {
  if (config.effects.empty()) return;
  diagnose::MissionInput without =
      diagnose::without(config.effects, {std::move(recordings.imu), std::move(recordings.gnss), std::move(setup)}, progress);
  recordings.imu = std::move(without.imu);
  recordings.gnss = std::move(without.gnss);
  setup = std::move(without.setup);
}

}  // namespace coast::jobs
