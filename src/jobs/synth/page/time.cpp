#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "synth/page/parts.hpp"

namespace coast::jobs {

namespace {

report::Panel lag_panel(const ArrayConfig& config, const SynthResult& result) {
  const array::Assembly& assembly = result.assembly;
  report::Panel panel =
      report::time_panel("lags", "Lags by the signals", "ms",
                         "Each window's lag with one sigma, and the line taken out. Good: dots about their line.");
  for (std::size_t k = 0; k < assembly.lags.size(); ++k) {
    if (!assembly.lags[k]) continue;
    const array::LagCurve& lag = *assembly.lags[k];
    report::Series windows;
    for (const array::Lag& window : lag.windows) {
      windows.x.push_back(window.at_s);
      windows.y.push_back(1e3 * window.lag_s);
    }
    const double end = static_cast<double>(assembly.signals.samples()) * assembly.signals.dt;
    report::add_points(panel.plot(), config.imus[k].name + ", windows", std::move(windows)).radius_px = 2.5;
    report::add_line(panel.plot(), config.imus[k].name, curve({0.0, end}, {1e3 * lag.at(0.0), 1e3 * lag.at(end)}));
  }
  return panel;
}

report::Table lag_table(const ArrayConfig& config, const SynthResult& result) {
  report::Table table{"lag-table",
                      "Lag and drift",
                      fmt::format("Against {}. What is tagged t happened at t minus the lag.", config.imus.front().name),
                      {},
                      {}};
  table.columns = {{"IMU", "", false}, {"lag", "ms"},        {"one sigma", "ms"},
                   {"drift", "ppm"},   {"one sigma", "ppm"}, {"windows", ""}};
  for (std::size_t k = 0; k < result.assembly.lags.size(); ++k) {
    if (!result.assembly.lags[k]) continue;
    const array::LagCurve& lag = *result.assembly.lags[k];
    table.rows.push_back(
        cells({config.imus[k].name, decimals(1e3 * lag.offset_s, 3), decimals(1e3 * lag.offset_sigma_s, 3),
               decimals(lag.drift_ppm, 1), number(lag.drift_sigma_ppm), fmt::format("{}", lag.windows.size())}));
  }
  return table;
}

/// The paper's Fig. 8: intervals between samples as received, and by the clock.
report::Panel interval_panel(const ArrayConfig& config, const SynthResult& result) {
  std::vector<std::string> names;
  for (const ArrayImu& imu : config.imus) names.push_back(imu.name);
  report::Panel panel =
      report::stacked_time_panel("intervals", "Sampling intervals", names, "ms",
                                 "Between neighbouring samples: as packets arrived, and by the estimated clock. "
                                 "Good: the clock's is a straight line at the nominal interval.");
  const double start = result.assembly.signals.start.sow();
  for (std::size_t k = 0; k < result.timed.size(); ++k) {
    std::vector<double> t;
    std::vector<double> arrival;
    std::vector<double> corrected;
    for (const array::SamplingInterval& interval : result.timed[k].intervals) {
      t.push_back(interval.time_s - start);
      arrival.push_back(1e3 * interval.arrival_s);
      corrected.push_back(1e3 * interval.corrected_s);
    }
    report::add_line(panel.plots[k], "arrivals", curve(t, arrival), report::Tone::kFaint);
    report::add_line(panel.plots[k], "clock", curve(t, corrected), report::Tone::kSmoothed);
  }
  return panel;
}

report::Table packet_table(const ArrayConfig& config, const SynthResult& result) {
  report::Table table{
      "packets", "Packets and clocks", "A clock's drift is that of the device's second against GPS time.", {}, {}};
  table.columns = {{"IMU", "", false}, {"received", ""}, {"lost", ""},     {"doubled", ""},
                   {"reordered", ""},  {"restarts", ""}, {"drift", "ppm"}, {"one sigma", "ppm"}};
  for (std::size_t k = 0; k < result.timed.size(); ++k) {
    const array::TimedRecording& timed = result.timed[k];
    const array::ClockFit& clock = timed.clocks.front();
    table.rows.push_back(
        cells({config.imus[k].name, fmt::format("{}", timed.report.received), fmt::format("{}", timed.report.lost),
               fmt::format("{}", timed.report.doubled), fmt::format("{}", timed.report.reordered),
               fmt::format("{}", timed.report.restarts()), decimals(clock.drift_ppm, 3), number(clock.drift_sigma_ppm)}));
  }
  return table;
}

}  // namespace

report::Section array_time_section(const ArrayConfig& config, const SynthResult& result) {
  report::Section section{"time", "Time", "", {}, {}, {}};
  if (!result.timed.empty()) {
    section.tables.push_back(packet_table(config, result));
    section.panels.push_back(interval_panel(config, result));
  }
  const bool any = std::ranges::any_of(result.assembly.lags, [](const auto& lag) { return lag.has_value(); });
  if (any) {
    section.tables.push_back(lag_table(config, result));
    section.panels.push_back(lag_panel(config, result));
  } else {
    section.lead = "No lags were found by the signals: time tags are believed.";
  }
  return section;
}

report::Section array_mounting_section(const ArrayConfig& config, const SynthResult& result) {
  const array::Assembly& assembly = result.assembly;
  report::Section section{"mounting", "Mounting", "", {}, {}, {}};
  section.lead = fmt::format(
      "Angular acceleration by a differentiator over {} samples, wrong by {} deg/s^2 (one sigma), which {} mm of lever arm "
      "turn into "
      "{} mm/s^2.",
      2 * assembly.differentiator_half_width + 1, number(assembly.alpha_error_sd / geo::kDegree), 100,
      number(100.0 * assembly.alpha_error_sd));
  if (!assembly.mounting) return section;
  const array::RefinedMounting& mounting = *assembly.mounting;
  section.lead += fmt::format(
      " Refined from the signals: rates differ by {} deg/s rms instead of {}, specific forces by {} m/s^2 instead of {}.",
      number(mounting.rates_after / geo::kDegree), number(mounting.rates_before / geo::kDegree), number(mounting.forces_after),
      number(mounting.forces_before));
  report::Table table{"mounting-table",
                      "Attitude and place against what was stated",
                      "What all sensors have in common cannot be seen and stays as stated.",
                      {},
                      {}};
  table.columns = {
      {"IMU", "", false}, {"rotation x / y / z", "deg"}, {"one sigma", "deg"}, {"place x / y / z", "m"}, {"one sigma", "m"}};
  for (std::size_t k = 0; k < mounting.sensors.size(); ++k) {
    const array::RefinedSensor& sensor = mounting.sensors[k];
    table.rows.push_back(
        cells({config.imus[k].name, triple(sensor.rotation / geo::kDegree), triple(sensor.rotation_sd / geo::kDegree),
               triple(sensor.frame.r_b), triple(sensor.position_sd_m)}));
  }
  section.tables.push_back(std::move(table));
  return section;
}

report::Section array_defect_section(const ArrayConfig& config, const SynthResult& result) {
  const array::Assembly& assembly = result.assembly;
  report::Section section{"defects", "Defects", "", {}, {}, {}};
  if (!config.assembly.defects) {
    section.lead = "Not looked for.";
    return section;
  }
  section.lead =
      fmt::format("Parity tests with {} false alarms per hour.", number(config.assembly.defects->false_alarms_per_hour));
  report::Table table{"defect-table", "Sensors left out", "", {}, {}};
  table.columns = {{"IMU", "", false}, {"kind", "", false}, {"channels", "", false}, {"from", "s"},
                   {"to", "s"},        {"found", "s"},      {"statistic", "sigma"}};
  for (const array::Defect& defect : assembly.defects.defects) {
    std::vector<std::string> channels;
    for (int c = 0; c < array::kChannels; ++c)
      if (((defect.channels >> c) & 1U) != 0) channels.push_back(channel_name(c));
    const auto at = [&](std::size_t n) { return decimals(static_cast<double>(n) * assembly.signals.dt, 2); };
    table.rows.push_back(
        cells({config.imus.at(defect.sensor).name, std::string(array::name_of(defect.kind)), joined(channels, ", "),
               at(defect.from), at(defect.to), at(defect.found), number(defect.statistic)}));
  }
  for (const array::Disagreement& d : assembly.defects.disagreements)
    section.notes.push_back({report::Note::Kind::kWarning, "",
                             fmt::format("{} and {} contradict each other in {} at {} s; no third sensor says which is wrong.",
                                         config.imus.at(d.a).name, config.imus.at(d.b).name, channel_name(d.channel),
                                         decimals(static_cast<double>(d.found) * assembly.signals.dt, 1))});
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  return section;
}

}  // namespace coast::jobs
