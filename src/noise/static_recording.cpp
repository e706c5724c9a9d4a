#include "coast/noise/static_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"

namespace coast::noise {

namespace {

constexpr double kGapFactor = 1.5;  // as in the readers: after a longer step samples are missing

/// Samples of the part, and the mean step between adjacent samples without a gap.
struct GridStretch {
  std::size_t first = 0;
  std::size_t end = 0;
  double interval = 0.0;
};

GridStretch stretch_of(const record::ImuRecording& imu, const RecordingPart& part) {
  const auto& samples = imu.samples;
  if (samples.size() < 2) throw InputError({imu.source, 0, fmt::format("{} samples", samples.size()), "at least two", ""});
  const geo::GpsTime start = samples.front().t - samples.front().dt;
  const auto at = [&](double seconds) {
    return static_cast<std::size_t>(std::ranges::upper_bound(samples, start + seconds, {}, &record::ImuSample::t) -
                                    samples.begin());
  };
  GridStretch stretch{0, samples.size()};
  if (part.from_s) stretch.first = at(*part.from_s);
  if (part.to_s) stretch.end = at(*part.to_s);
  if (stretch.end < stretch.first + 2)
    throw InputError({imu.source, 0, fmt::format("{:.3f} s of recording", samples.back().t - start),
                      fmt::format("at least two samples from {:g} s to {}", part.from_s.value_or(0.0),
                                  part.to_s ? fmt::format("{:g} s", *part.to_s) : "the end"),
                      "from_s and to_s count from the first sample."});
  const double longest = kGapFactor / imu.rate_hz;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = stretch.first; i < stretch.end; ++i)
    if (samples[i].dt <= longest) {
      sum += samples[i].dt;
      count += 1.0;
    }
  // Times in seconds of week are rounded: a rate this close to a multiple of 0.001 Hz is assumed to be exact.
  constexpr double kMeant = 1e-9;
  const double rate = count > 0.0 ? count / sum : imu.rate_hz;
  const double round = std::round(1e3 * rate) / 1e3;
  stretch.interval = 1.0 / (std::abs(rate - round) < kMeant * rate ? round : rate);
  return stretch;
}

/// Grid positions of the samples that are kept.
struct Grid {
  std::vector<StaticSignal::Run> runs;
  std::vector<std::size_t> samples;
  std::size_t holes = 0;
  std::uint64_t missing = 0;  ///< intervals without a sample
  double worst = 0.0;         ///< error of rounding a hole to the grid, intervals
};

Grid grid_of(const record::ImuRecording& imu, const GridStretch& stretch) {
  Grid grid;
  grid.samples.reserve(stretch.end - stretch.first);
  std::uint64_t at = 0;
  const double longest = kGapFactor / imu.rate_hz;
  for (std::size_t i = stretch.first; i < stretch.end; ++i) {
    const double dt = imu.samples[i].dt;
    if (dt > longest) {
      if (grid.samples.empty()) continue;
      const double steps = dt / stretch.interval;
      const double whole = std::max(1.0, std::round(steps));
      at += static_cast<std::uint64_t>(whole);
      grid.missing += static_cast<std::uint64_t>(whole);
      grid.worst = std::max(grid.worst, std::abs(steps - whole));
      ++grid.holes;
      continue;
    }
    if (grid.runs.empty() || grid.runs.back().start + grid.runs.back().count != at)
      grid.runs.push_back({at, grid.samples.size(), 0});
    ++grid.runs.back().count;
    grid.samples.push_back(i);
    ++at;
  }
  return grid;
}

double square(double x) {
  return x * x;
}

/// Root of the mean over axes of the variance between recordings.
double spread_of(std::span<const std::array<double, 3>> levels) {
  const auto n = static_cast<double>(levels.size());
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double mean = 0.0;
    for (const auto& level : levels) mean += level[axis] / n;
    for (const auto& level : levels) sum += square(level[axis] - mean) / (3.0 * (n - 1.0));
  }
  return std::sqrt(sum);
}

TurnOnBias gyro_bias(std::span<const std::array<double, 3>> levels) {
  double sum = 0.0;
  for (const auto& level : levels)
    for (const double rate : level) sum += square(rate) / (3.0 * static_cast<double>(levels.size()));
  const double rms = std::sqrt(sum);
  if (rms > 3.0 * geo::kEarthRate)
    return {rms, fmt::format("root mean square of the levels of 3 axes in {} recording{}, about zero", levels.size(),
                             levels.size() == 1 ? "" : "s")};
  if (levels.size() > 1)
    return {spread_of(levels), fmt::format("standard deviation of an axis between {} recordings", levels.size())};
  return {3.0 * geo::kEarthRate, "default, three times the Earth's rate: one recording does not tell a smaller bias from it"};
}

TurnOnBias accel_bias(std::span<const std::array<double, 3>> levels) {
  constexpr double kGravityVaries = 0.03;  // m/s^2, from the equator to the poles and up to some km of height
  double norm = 0.0;
  for (const auto& level : levels)
    norm += std::sqrt(square(level[0]) + square(level[1]) + square(level[2])) / static_cast<double>(levels.size());
  const double excess = std::abs(norm - geo::kStandardGravity);
  const bool off = excess > kGravityVaries;
  const std::string norm_text = fmt::format("the norm of the levels, {:.3f} m/s^2, minus standard gravity", norm);
  if (levels.size() > 1) {
    const double spread = spread_of(levels);
    const std::string between = fmt::format("standard deviation of an axis between {} recordings", levels.size());
    return off ? TurnOnBias{std::hypot(spread, excess), between + ", and " + norm_text} : TurnOnBias{spread, between};
  }
  const double fallback = 20e-3 * geo::kStandardGravity;
  if (off && excess > fallback) return {excess, norm_text};
  return {fallback, "default, 20 mg: one recording does not tell bias from gravity"};
}

}  // namespace

StaticRecording static_recording(const record::ImuRecording& imu, const RecordingPart& part) {
  const GridStretch stretch = stretch_of(imu, part);
  const Grid grid = grid_of(imu, stretch);
  StaticRecording recording{imu.source, stretch.interval, {}, {}};
  for (int axis = 0; axis < 6; ++axis) {
    StaticSignal signal{imu.source, stretch.interval, {}, grid.runs};
    signal.values.reserve(grid.samples.size());
    for (const std::size_t i : grid.samples) {
      const record::ImuSample& s = imu.samples[i];
      signal.values.push_back((axis < 3 ? s.dtheta(axis) : s.dv(axis - 3)) / s.dt);
    }
    recording.axes.push_back(std::move(signal));
  }
  if (grid.holes > 0)
    recording.remarks.push_back(fmt::format(
        "{} hole{} of {} intervals in all, each with the sample behind it; lengths were rounded to whole intervals, by {:.2f} "
        "of one at most. Nothing stands in for what is missing.",
        grid.holes, grid.holes == 1 ? "" : "s", grid.missing, grid.worst));
  return recording;
}

void share_interval(std::vector<StaticRecording>& recordings) {
  double sum = 0.0;
  double weight = 0.0;
  for (const StaticRecording& r : recordings) {
    const auto samples = static_cast<double>(r.axes.front().values.size());
    sum += samples * r.interval;
    weight += samples;
  }
  const double interval = sum / weight;
  for (StaticRecording& r : recordings) {
    const double off = r.interval / interval - 1.0;
    if (std::abs(off) > 0.01)
      throw InputError({r.source, 0, fmt::format("a rate of {:.6g} Hz", 1.0 / r.interval),
                        fmt::format("that of the other recordings, {:.6g} Hz within 1 %", 1.0 / interval),
                        "Recordings of one calibration have one rate."});
    if (std::abs(off) > 1e-6)
      r.remarks.push_back(
          fmt::format("its own rate, {:.8g} Hz, was taken as the common {:.8g} Hz", 1.0 / r.interval, 1.0 / interval));
    r.interval = interval;
    for (StaticSignal& signal : r.axes) signal.interval = interval;
  }
}

TurnOnBias turn_on_bias(Sensor sensor, std::span<const std::array<double, 3>> levels) {
  return sensor == Sensor::kGyro ? gyro_bias(levels) : accel_bias(levels);
}

}  // namespace coast::noise
