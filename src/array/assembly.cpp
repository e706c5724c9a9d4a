#include "coast/array/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coast/array/channel.hpp"
#include "coast/array/resample.hpp"
#include "coast/parallel.hpp"

namespace coast::array {

namespace {

constexpr double kShortestInCommon = 20.0;  // s of common time, required by the tests of defects

/// The time common to all recordings.
Grid common_grid(const std::vector<ArrayMember>& members, double rate_hz) {
  Grid grid;
  const record::ImuRecording& first = *members.front().recording;
  grid.dt = 1.0 / (rate_hz > 0.0 ? rate_hz : first.rate_hz);
  grid.start = first.samples.front().t - first.samples.front().dt;
  geo::GpsTime end = first.samples.back().t;
  for (const ArrayMember& member : members) {
    const auto& samples = member.recording->samples;
    grid.start = std::max(grid.start, samples.front().t - samples.front().dt);
    end = std::min(end, samples.back().t);
  }
  const double seconds = end - grid.start;
  if (seconds < kShortestInCommon)
    throw std::invalid_argument(fmt::format("the recordings have {:.1f} s in common, at least {:.0f} s are needed",
                                            std::max(seconds, 0.0), kShortestInCommon));
  grid.samples = static_cast<std::size_t>(std::floor(seconds / grid.dt + 1e-6));
  return grid;
}

LagOfTag lag_of(const std::vector<std::optional<LagCurve>>& lags, std::size_t k, geo::GpsTime start) {
  if (k >= lags.size() || !lags[k]) return {};
  return LinearLag{start + lags[k]->reference_s, lags[k]->offset_s, lags[k]->drift_ppm};
}

Signals on_grid(const std::vector<ArrayMember>& members, const Grid& grid, const std::vector<std::optional<LagCurve>>& lags) {
  Signals signals{grid.start, grid.dt, {}};
  signals.sensors.resize(members.size());
  coast::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
    signals.sensors[k] = resample(*members[k].recording, grid, lag_of(lags, k, grid.start));
    signals.sensors[k].name = members[k].name;
  });
  return signals;
}

/// The stretch in which every recording has samples within the length of resampling: its ends are no dropouts.
void crop_ends(Signals& signals) {
  constexpr double kMost = 2.0;  // s, at either end: if more is missing, it is a dropout
  const auto whole = [&](std::size_t n) {
    return std::ranges::all_of(signals.sensors, [n](const SensorSignals& sensor) { return sensor.usable[n] == kAllUsable; });
  };
  const auto most = static_cast<std::size_t>(kMost / signals.dt);
  std::size_t first = 0;
  std::size_t end = signals.samples();
  while (first < std::min(most, end) && !whole(first)) ++first;
  while (signals.samples() - end < most && end > first + 1 && !whole(end - 1)) --end;
  if (first == most || signals.samples() - end == most) return;
  for (SensorSignals& sensor : signals.sensors) {
    sensor.values = sensor.values.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(end - first)).eval();
    sensor.usable = std::vector<std::uint8_t>(sensor.usable.begin() + static_cast<std::ptrdiff_t>(first),
                                              sensor.usable.begin() + static_cast<std::ptrdiff_t>(end));
  }
  signals.start = signals.start + static_cast<double>(first) * signals.dt;
}

void say(record::Events& events, record::Event::Severity severity, const char* kind, std::string text) {
  events.push_back({severity, kind, std::move(text), std::nullopt, 1});
}

/// "imu3: the gyro is at the end of its range, .."
void tell_range(const std::string& name, const char* triad, const std::string& most, std::size_t values,
                record::Events& events) {
  if (values == 0) return;
  say(events, record::Event::Severity::kWarning, "saturation",
      fmt::format("{}: the {} is at the end of its range, {}, in {} values; left out where another is not", name, triad, most,
                  values));
}

/// Samples at the end of a sensor's range. Lags and mounting are found with them: what is cut off is the same for all, nearly.
void leave_out_ends_of_ranges(const std::vector<ArrayMember>& members, geo::GpsTime lags_from, Assembly& assembly) {
  const Grid grid{assembly.signals.start, assembly.signals.dt, assembly.signals.samples()};
  assembly.saturation.resize(members.size());
  std::vector<std::vector<std::uint8_t>> wrong(members.size());
  coast::parallel_for(std::size_t{0}, members.size(), [&](std::size_t k) {
    assembly.saturation[k] = find_saturation(*members[k].recording);
    wrong[k] = mark_saturation(assembly.signals.sensors[k], assembly.saturation[k], *members[k].recording, grid,
                               lag_of(assembly.lags, k, lags_from));
  });
  leave_out_where_others_are_not(assembly.signals, wrong);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Saturation& own = assembly.saturation[k];
    tell_range(members[k].name, "gyro",
               fmt::format("{:.0f} deg/s", std::max({own.most[0], own.most[1], own.most[2]}) * 180.0 / std::numbers::pi),
               own.count[0] + own.count[1] + own.count[2], assembly.events);
    tell_range(members[k].name, "accelerometer", fmt::format("{:.1f} m/s^2", std::max({own.most[3], own.most[4], own.most[5]})),
               own.count[3] + own.count[4] + own.count[5], assembly.events);
  }
}

/// Lags of all members relative to the first, in body axes as stated.
std::vector<std::optional<LagCurve>> find_lags(Signals signals, const std::vector<SensorFrame>& frames,
                                               const LagOptions& options, record::Events& events) {
  turn_to_body(signals, frames);
  std::vector<std::optional<LagCurve>> lags(frames.size());
  coast::parallel_for(std::size_t{1}, frames.size(), [&](std::size_t k) {
    lags[k] = lag_curve(signals.sensors.front(), signals.sensors[k], signals.dt, options);
    // One window cannot determine the drift.
    if (lags[k] && !std::isfinite(lags[k]->drift_sigma_ppm)) lags[k]->drift_ppm = 0.0;
  });
  for (std::size_t k = 1; k < frames.size(); ++k)
    if (!lags[k])
      say(events, record::Event::Severity::kWarning, "no_lag",
          fmt::format("{}: too little motion to match its time with {}'s; its time tags are believed", signals.sensors[k].name,
                      signals.sensors.front().name));
  return lags;
}

/// Adds the lags that remain after correction: if a clock drifts, a window's lag is that of the motion in it, and the time of
/// this motion in the window is known better the smaller the drift.
void add_remaining(std::vector<std::optional<LagCurve>>& lags, const std::vector<std::optional<LagCurve>>& left) {
  for (std::size_t k = 0; k < lags.size(); ++k) {
    if (!lags[k] || !left[k]) continue;
    LagCurve sum = *left[k];
    for (Lag& window : sum.windows) window.lag_s += lags[k]->at(window.at_s);
    sum.offset_s += lags[k]->at(sum.reference_s);
    sum.drift_ppm += lags[k]->drift_ppm;
    lags[k] = sum;
  }
}

std::vector<SensorFrame> stated_frames(const std::vector<ArrayMember>& members) {
  std::vector<SensorFrame> frames;
  for (const ArrayMember& member : members) frames.push_back(member.frame);
  return frames;
}

void refine_frames(const Signals& sensor_axes, const AssemblyOptions& options, Assembly& assembly) {
  if (!options.mounting) return;
  try {
    assembly.mounting = refine_mounting(sensor_axes, assembly.frames, *options.mounting);
  } catch (const std::invalid_argument& error) {
    say(assembly.events, record::Event::Severity::kWarning, "mounting_as_stated",
        fmt::format("the mounting is left as stated: {}", error.what()));
    return;
  }
  for (std::size_t k = 0; k < assembly.frames.size(); ++k) assembly.frames[k] = assembly.mounting->sensors[k].frame;
}

/// Also corrects the lags that remain with these frames.
void match_again(const std::vector<ArrayMember>& members, const Grid& grid, const LagOptions& options, Assembly& assembly) {
  record::Events said_already;
  add_remaining(assembly.lags, find_lags(assembly.signals, assembly.frames, options, said_already));
  assembly.signals = on_grid(members, grid, assembly.lags);
}

/// Synchronised signals, in their own axes, with refined frames. Times are matched in body axes: an error of the attitude mixes
/// the axes and moves the maximum of the correlation by 20 us per degree and more. So they are matched again with the refined
/// frames, and the frames are refined again with these times, starting from the stated ones.
void match_and_mount(const std::vector<ArrayMember>& members, const Grid& grid, const AssemblyOptions& options,
                     const std::function<void(const char*, double)>& tell, Assembly& assembly) {
  tell("resampling", 0.0);
  assembly.signals = on_grid(members, grid, {});
  if (options.lags) {
    tell("matching times", 0.1);
    assembly.lags = find_lags(assembly.signals, assembly.frames, *options.lags, assembly.events);
    assembly.signals = on_grid(members, grid, assembly.lags);
    match_again(members, grid, *options.lags, assembly);
  }
  crop_ends(assembly.signals);
  tell("refining the mounting", 0.3);
  refine_frames(assembly.signals, options, assembly);
  if (!options.lags || !assembly.mounting) return;
  assembly.signals = on_grid(members, grid, assembly.lags);
  match_again(members, grid, *options.lags, assembly);
  crop_ends(assembly.signals);
  tell("refining the mounting", 0.45);
  assembly.frames = stated_frames(members);
  refine_frames(assembly.signals, options, assembly);
}

/// After a jump of its bias a sensor is used again, with the bias of its first stretch in order.
void undo_bias_jumps(Signals& signals, const std::vector<BiasRun>& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto first = std::ranges::find(runs, runs[i].sensor, &BiasRun::sensor);
    const Channels jump = runs[i].bias - first->bias;
    if (first->from == runs[i].from || jump.isZero(0.0)) continue;
    const auto from = static_cast<Eigen::Index>(runs[i].from);
    const auto count = static_cast<Eigen::Index>(runs[i].to - runs[i].from);
    signals.sensors.at(runs[i].sensor).values.middleCols(from, count).colwise() -= jump;
  }
}

}  // namespace

Assembly assemble(const std::vector<ArrayMember>& members, const AssemblyOptions& options,
                  const std::function<void(const char*, double)>& progress) {
  if (members.size() < 2) throw std::invalid_argument(fmt::format("{} IMUs: an array has two or more", members.size()));
  const auto tell = [&](const char* what, double share) {
    if (progress) progress(what, share);
  };
  Assembly assembly;
  assembly.frames = stated_frames(members);
  const Grid grid = common_grid(members, options.rate_hz);
  match_and_mount(members, grid, options, tell, assembly);
  leave_out_ends_of_ranges(members, grid.start, assembly);
  turn_to_body(assembly.signals, assembly.frames);
  const AngularMotion motion = angular_motion(assembly.signals);
  assembly.differentiator_half_width = motion.half_width;
  assembly.alpha_error_sd = motion.error_sd;
  move_to_origin(assembly.signals, assembly.frames, motion);
  mark_forces_moved_by_limited_rates(assembly.signals);
  if (options.defects) {
    tell("testing for defects", 0.6);
    assembly.defects = find_defects(assembly.signals, *options.defects);
    exclude(assembly.signals, assembly.defects);
    undo_bias_jumps(assembly.signals, assembly.defects.biases);
  }
  tell("taking off offsets", 0.9);
  assembly.levelled = assembly.signals;
  static_cast<void>(take_off_relative_offsets(assembly.levelled, options.offset_window_s));
  return assembly;
}

}  // namespace coast::array
