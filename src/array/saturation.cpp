#include "coast/array/saturation.hpp"

#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

constexpr std::uint8_t kRateBits = 0x07;
constexpr std::uint8_t kForceBits = 0x38;

/// The rate of sample i as it was recorded: increment over interval.
double rate_of(const record::ImuSample& sample, int channel) {
  return (channel < 3 ? sample.dtheta(channel) : sample.dv(channel - 3)) / sample.dt;
}

/// A value and how many samples have it. Increments over intervals leave rounding errors in what was one number.
struct ValueCount {
  double value;
  std::size_t count;
};

bool same_value(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

std::vector<ValueCount> counted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<ValueCount> counts;
  for (const double value : values) {
    if (counts.empty() || !same_value(counts.back().value, value))
      counts.push_back({value, 1});
    else
      ++counts.back().count;
  }
  return counts;
}

/// @param outermost_first  values from an extreme inwards
bool piles_up(const ValueCount* outermost_first, std::ptrdiff_t step) {
  constexpr std::size_t kFewest = 4;
  constexpr std::size_t kTimesItsNeighbours = 3;
  constexpr std::ptrdiff_t kNeighbours = 5;
  std::size_t most = 0;
  for (std::ptrdiff_t i = 1; i <= kNeighbours; ++i) most = std::max(most, outermost_first[i * step].count);
  return outermost_first->count >= kFewest && outermost_first->count >= kTimesItsNeighbours * most;
}

/// A value that is held once is a sensor that is stuck.
bool in_separate_places(const std::vector<double>& values, double end) {
  constexpr int kPlaces = 3;
  int places = 0;
  for (std::size_t i = 0; i < values.size() && places < kPlaces; ++i)
    if (same_value(values[i], end) && (i == 0 || !same_value(values[i - 1], end))) ++places;
  return places == kPlaces;
}

/// The ends of one channel's range that it reaches.
std::vector<double> ends_of(const std::vector<double>& values) {
  constexpr std::size_t kLeastDifferent = 100;
  const std::vector<ValueCount> counts = counted(values);
  std::vector<double> ends;
  if (counts.size() < kLeastDifferent) return ends;
  if (piles_up(&counts.back(), -1) && in_separate_places(values, counts.back().value)) ends.push_back(counts.back().value);
  if (piles_up(&counts.front(), 1) && in_separate_places(values, counts.front().value)) ends.push_back(counts.front().value);
  return ends;
}

}  // namespace

bool Saturation::any() const {
  return std::ranges::any_of(count, [](std::size_t n) { return n > 0; });
}

Saturation find_saturation(const record::ImuRecording& recording) {
  Saturation saturation;
  saturation.samples.assign(recording.samples.size(), 0);
  std::vector<double> values(recording.samples.size());
  for (int c = 0; c < kChannels; ++c) {
    const auto at = static_cast<std::size_t>(c);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = rate_of(recording.samples[i], c);
    for (const double end : ends_of(values)) {
      saturation.most.at(at) = std::max(saturation.most.at(at), std::abs(end));
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!same_value(values[i], end)) continue;
        saturation.samples[i] = static_cast<std::uint8_t>(saturation.samples[i] | (1U << c));
        ++saturation.count.at(at);
      }
    }
  }
  return saturation;
}

namespace {

struct ColumnsOf {
  std::size_t first, end;
};

/// The columns within `reach` of a sample's interval, which ends at `end` of the grid's time.
ColumnsOf columns_within(double end, double interval, double reach, const Grid& grid) {
  const double most = static_cast<double>(grid.samples);
  return {static_cast<std::size_t>(std::clamp(std::floor((end - interval - reach) / grid.dt), 0.0, most)),
          static_cast<std::size_t>(std::clamp(std::ceil((end + reach) / grid.dt), 0.0, most))};
}

}  // namespace

void mark_saturation(SensorSignals& sensor, const Saturation& saturation, const record::ImuRecording& recording,
                     const Grid& grid, const LagOfTag& lag) {
  constexpr double kReach = 16.0;  // intervals of the lower rate, as `resample`
  constexpr double kWrong = 1.0;
  sensor.limited.clear();
  if (!saturation.any()) return;
  sensor.limited.assign(grid.samples, 0);
  for (std::size_t i = 0; i < saturation.samples.size(); ++i) {
    if (saturation.samples[i] == 0) continue;
    std::uint8_t bits = 0;
    if ((saturation.samples[i] & kRateBits) != 0) bits = static_cast<std::uint8_t>(bits | kRateBits);
    if ((saturation.samples[i] & kForceBits) != 0) bits = static_cast<std::uint8_t>(bits | kForceBits);
    const record::ImuSample& sample = recording.samples[i];
    const double end = (sample.t - grid.start) - (lag ? lag(sample.t) : 0.0);
    const double interval = std::max(sample.dt, grid.dt);
    const ColumnsOf touched = columns_within(end, sample.dt, kReach * interval, grid);
    for (std::size_t n = touched.first; n < touched.end; ++n)
      sensor.limited[n] = static_cast<std::uint8_t>(sensor.limited[n] | bits);
    const ColumnsOf wrong = columns_within(end, sample.dt, kWrong * interval, grid);
    for (std::size_t n = wrong.first; n < wrong.end; ++n)
      sensor.usable[n] = static_cast<std::uint8_t>(sensor.usable[n] & ~bits);
  }
}

void use_where_all_are_limited(Signals& signals) {
  for (const std::uint8_t kind : {kRateBits, kForceBits}) {
    for (std::size_t n = 0; n < signals.samples(); ++n) {
      const auto usable = [&](const SensorSignals& sensor) { return (sensor.usable[n] & kind) != 0; };
      if (std::ranges::any_of(signals.sensors, usable)) continue;
      for (SensorSignals& sensor : signals.sensors)
        if (!sensor.limited.empty())
          sensor.usable[n] = static_cast<std::uint8_t>(sensor.usable[n] | (sensor.limited[n] & kind));
    }
  }
}

void mark_forces_moved_by_limited_rates(Signals& signals) {
  std::vector<std::uint8_t> forces(signals.samples(), 0);
  bool any = false;
  for (const SensorSignals& sensor : signals.sensors) {
    for (std::size_t n = 0; n < sensor.limited.size(); ++n) {
      if ((sensor.limited[n] & kRateBits) == 0) continue;
      forces[n] = kForceBits;
      any = true;
    }
  }
  if (!any) return;
  for (SensorSignals& sensor : signals.sensors) {
    sensor.limited.resize(signals.samples(), 0);
    for (std::size_t n = 0; n < forces.size(); ++n)
      sensor.limited[n] = static_cast<std::uint8_t>(sensor.limited[n] | forces[n]);
  }
}

}  // namespace coast::array
