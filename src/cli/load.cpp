#include "load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <system_error>

#include "coast/geo/leap_seconds.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/io/inspect.hpp"
#include "coast/io/member_blocks.hpp"
#include "coast/io/noise_levels.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/record/error.hpp"
#include "ppk_summary.hpp"

namespace coast::cli {

namespace {

// Nobody knows the leap seconds of years to come: beyond the table's last word a file in UTC may be a second off.
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

// Positions from the rover's and the base's observations; what was found of them is told like the rest.
void read_with_ppk(const RunConfig& config, const study::Progress& progress, Recordings& recordings) {
  PpkResult ppk = run_ppk(*config.ppk, [&progress](double share) { progress("solving GNSS positions", share); });
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

Recordings load(const RunConfig& config, const study::Progress& progress) {
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
  ins::to_body(recordings.imu, config.setup.C_s_b);
  io::Inspection inspection = io::inspect(recordings.imu, recordings.gnss);
  std::ranges::move(inspection.sentences, std::back_inserter(recordings.inspection));
  recordings.inspection_events = std::move(inspection.events);
  recordings.time_shift_s = inspection.time_shift_s;
  check_leap_seconds(config.imu.time, recordings.imu.source, recordings.imu.samples.back().t, recordings.inspection_events);
  check_leap_seconds(config.gnss.time, recordings.gnss.source, recordings.gnss.fixes.back().t, recordings.inspection_events);
  if (config.reference) recordings.reference = io::read_reference(*config.reference, recordings.imu.samples.front().t);
  return recordings;
}

void print_inspection(const Recordings& recordings, bool quiet) {
  if (!quiet)
    for (const std::string& sentence : recordings.inspection) fmt::print("{}\n", sentence);
  const auto warn = [](const record::Events& events) {
    for (const record::Event& event : events)
      if (event.severity == record::Event::Severity::kWarning) fmt::print(stderr, "warning: {}\n", event.text);
  };
  warn(recordings.imu.events);
  warn(recordings.gnss.events);
  if (recordings.reference) warn(recordings.reference->events);
  warn(recordings.inspection_events);
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
  setup.unstated = {};  // what is not stated is tested by `process` alone: outages and diagnoses compare stated models
  setup.carrier = recordings.carrier;
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
                           event.text + " (`accept: true` processes it all the same)");
}

void refuse_wrong_units(const RunConfig& config, const Recordings& recordings) {
  if (config.accept) return;
  for (const record::Event& event : recordings.inspection_events)
    if (event.kind == "gyro_unit" || event.kind == "specific_force_unit")
      throw NumericalError("the units contradict gravity or the course", "",
                           event.text + " (`accept: true` searches all the same)");
}

void take_out_effects(const RunConfig& config, Recordings& recordings, study::Setup& setup, const study::Progress& progress) {
  if (config.effects.empty()) return;
  diagnose::MissionInput without =
      diagnose::without(config.effects, {std::move(recordings.imu), std::move(recordings.gnss), std::move(setup)}, progress);
  recordings.imu = std::move(without.imu);
  recordings.gnss = std::move(without.gnss);
  setup = std::move(without.setup);
}

std::filesystem::path output_folder(const std::filesystem::path& input, const std::filesystem::path& out,
                                    std::vector<std::string> files) {
  std::filesystem::path folder = out;
  if (folder.empty()) {
    folder = input;
    folder.replace_extension(".out");
  }
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder))
    throw OutputError(folder.string(), failed ? failed.message() : "not a folder");
  // A run that repeats another would write its own file anew at the end.
  const std::string name = input.filename().string();
  if (name.ends_with(".resolved.yaml")) files.push_back(name);
  io::open_results_folder(folder, files);
  return folder;
}

}  // namespace coast::cli
