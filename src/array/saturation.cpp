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

void set_bits(std::vector<std::uint8_t>& columns, ColumnsOf span, std::uint8_t bits) {
  for (std::size_t n = span.first; n < span.end; ++n) columns[n] = static_cast<std::uint8_t>(columns[n] | bits);
}

/// The columns within `reach` of a sample's interval, which ends at `end` of the grid's time.
ColumnsOf columns_within(double end, double interval, double reach, const Grid& grid) {
  const double most = static_cast<double>(grid.samples);
  return {static_cast<std::size_t>(std::clamp(std::floor((end - interval - reach) / grid.dt), 0.0, most)),
          static_cast<std::size_t>(std::clamp(std::ceil((end + reach) / grid.dt), 0.0, most))};
}

}  // namespace

std::vector<std::uint8_t> mark_saturation(SensorSignals& sensor, const Saturation& saturation,
                                          const record::ImuRecording& recording, const Grid& grid, const LagOfTag& lag) {
  constexpr double kReach = 16.0;  // intervals of the lower rate, as `resample`
  constexpr double kWrong = 1.0;
  sensor.limited.clear();
  if (!saturation.any()) return {};
  sensor.limited.assign(grid.samples, 0);
  std::vector<std::uint8_t> wrong(grid.samples, 0);
  for (std::size_t i = 0; i < saturation.samples.size(); ++i) {
    if (saturation.samples[i] == 0) continue;
    std::uint8_t bits = 0;
    if ((saturation.samples[i] & kRateBits) != 0) bits = static_cast<std::uint8_t>(bits | kRateBits);
    if ((saturation.samples[i] & kForceBits) != 0) bits = static_cast<std::uint8_t>(bits | kForceBits);
    const record::ImuSample& sample = recording.samples[i];
    const double end = (sample.t - grid.start) - (lag ? lag(sample.t) : 0.0);
    const double interval = std::max(sample.dt, grid.dt);
    set_bits(sensor.limited, columns_within(end, sample.dt, kReach * interval, grid), bits);
    set_bits(wrong, columns_within(end, sample.dt, kWrong * interval, grid), bits);
  }
  return wrong;
}

void leave_out_where_others_are_not(Signals& signals, const std::vector<std::vector<std::uint8_t>>& wrong) {
  for (std::size_t n = 0; n < signals.samples(); ++n) {
    std::uint8_t right = 0;
    for (std::size_t k = 0; k < wrong.size(); ++k)
      right = static_cast<std::uint8_t>(right | (signals.sensors[k].usable[n] & ~(wrong[k].empty() ? 0 : wrong[k][n])));
    for (std::size_t k = 0; k < wrong.size(); ++k) {
      if (wrong[k].empty()) continue;
      std::uint8_t& usable = signals.sensors[k].usable[n];
      usable = static_cast<std::uint8_t>(usable & ~(wrong[k][n] & right));
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
