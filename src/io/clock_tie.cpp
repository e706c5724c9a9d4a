#include "clock_tie.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coast::io {

bool ClockTie::fit() {
  constexpr std::size_t kFewest = 10;
  constexpr double kShortest = 10.0;  // s
  constexpr double kMostMedians = 3.0, kLeastWidth = 1e-3;
  if (pairs_.size() < kFewest || (!nominal_ && pairs_.back().t - pairs_.front().t < kShortest)) return false;
  if (!fit_within(std::numeric_limits<double>::infinity())) return false;
  std::vector<double> distances;
  distances.reserve(pairs_.size());
  for (const Pair& pair : pairs_) distances.push_back(std::abs(distance(pair)));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  distance_ = *middle;
  return fit_within(std::max(kMostMedians * distance_, kLeastWidth));
}

/// Seconds after the first pair.
double ClockTie::seconds_at(std::int64_t counter) const {
  return offset_ + tick_ * static_cast<double>(counter - pairs_.front().counter);
}

double ClockTie::distance(const Pair& pair) const {
  return (pair.t - pairs_.front().t) - seconds_at(pair.counter);
}

std::optional<geo::GpsTime> ClockTie::at(std::int64_t counter) const {
  constexpr double kFarthest = 1e7;  // s
  const double seconds = seconds_at(counter);
  if (!(std::abs(seconds) < kFarthest)) return std::nullopt;
  return pairs_.front().t + seconds;
}

bool ClockTie::fit_within(double most) {
  const bool all = std::isinf(most);
  const std::int64_t zero = pairs_.front().counter;
  const geo::GpsTime start = pairs_.front().t;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const Pair& pair : pairs_) {
    if (!all && std::abs(distance(pair)) > most) continue;
    const auto x = static_cast<double>(pair.counter - zero);
    const double y = pair.t - start;
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  // Delays of tens of milliseconds over a minute: a slope to some 1e-4, which is worse than any quartz.
  constexpr double kSlopeFrom = 60.0;  // s
  const bool sloped = !nominal_ || pairs_.back().t - start > kSlopeFrom;
  const double determinant = n * sxx - sx * sx;
  const double tick = !sloped ? *nominal_ : determinant > 0.0 ? (n * sxy - sx * sy) / determinant : 0.0;
  constexpr double kLongestTick = 1.0;  // s
  if (!(n > 0.0 && tick > 0.0 && tick < kLongestTick)) return false;
  tick_ = tick;
  offset_ = (sy - tick * sx) / n;
  return true;
}

}  // namespace coast::io
