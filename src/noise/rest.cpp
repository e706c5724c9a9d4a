#include "coast/noise/rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/geo/units.hpp"
#include "resolution.hpp"

namespace coast::noise {

namespace {

constexpr double kWindow = 1.0;            // s
constexpr double kLongEnough = 60.0;       // s
constexpr std::size_t kBesideMotion = 2;   // windows; handling begins and ends gradually
constexpr double kScatters = 8.0;          // exceeded by none of 1e6 changes of white noise
constexpr double kOfWhiteNoise = 6.0;      // by none of 1e8; for coarse steps most changes are zero, and so is their quantile
constexpr double kBeyondWhiteNoise = 4.0;  // in units of the scatter of the means

/// Changes larger than any sensor error from one second to the next.
struct Motion {
  double least;       ///< change that may be motion
  double throughout;  ///< scatter of changes that is motion
};
constexpr Motion kGyro{0.2 * geo::kDegree, 0.5 * geo::kDegree};
constexpr Motion kAccelerometer{0.05, 0.15};

/// Mean of the available samples in each window; none if half of them are missing.
std::vector<double> window_means(const StaticSignal& signal, std::size_t length) {
  const std::size_t windows = static_cast<std::size_t>(signal.length()) / length;
  std::vector<double> sums(windows, 0.0);
  std::vector<std::size_t> counts(windows, 0);
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i) {
      const auto window = static_cast<std::size_t>(run.start + i) / length;
      if (window >= windows) break;
      sums[window] += signal.values[run.first + i];
      ++counts[window];
    }
  for (std::size_t w = 0; w < windows; ++w)
    sums[w] = 2 * counts[w] >= length ? sums[w] / static_cast<double>(counts[w]) : std::numeric_limits<double>::quiet_NaN();
  return sums;
}

/// Standard deviation by the lower quartile of absolute values: up to half of the changes may be motion.
double scatter_of_changes(std::vector<double> changes) {
  constexpr double kQuartileOfSizes = 0.3186;  // sigmas, of a normal distribution
  if (changes.empty()) return 0.0;
  const auto quartile = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 4);
  std::ranges::nth_element(changes, quartile);
  return *quartile / kQuartileOfSizes;
}

/// Marks the windows between which an axis changes by more than its own errors.
void mark(const StaticSignal& signal, const Motion& motion, std::size_t length, std::vector<bool>& moved) {
  const std::vector<double> means = window_means(signal, length);
  std::vector<double> changes;
  for (std::size_t w = 1; w < means.size(); ++w)
    if (const double change = std::abs(means[w] - means[w - 1]); std::isfinite(change)) changes.push_back(change);
  const double scatter = scatter_of_changes(changes);
  const double of_white_noise = white_scatter(signal) * std::sqrt(2.0 / static_cast<double>(length));  // two means' difference
  const bool throughout = scatter > motion.throughout && scatter > kBeyondWhiteNoise * of_white_noise;
  double limit = throughout ? motion.least : std::max(kScatters * scatter, motion.least);
  if (resolution_of(signal).hides_the_noise()) limit = std::max(limit, kOfWhiteNoise * of_white_noise);
  for (std::size_t w = 1; w < means.size(); ++w) {
    if (!(std::abs(means[w] - means[w - 1]) > limit)) continue;
    moved[w - 1] = moved[w] = true;
  }
}

}  // namespace

Rest rest_of(const StaticRecording& recording) {
  const StaticSignal& first = recording.axes.front();
  const std::size_t length = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(kWindow / first.interval)));
  const double window = static_cast<double>(length) * first.interval;
  std::vector<bool> moved(static_cast<std::size_t>(first.length()) / length, false);
  for (std::size_t axis = 0; axis < recording.axes.size(); ++axis)
    mark(recording.axes[axis], axis < 3 ? kGyro : kAccelerometer, length, moved);

  Rest rest{first.duration(), window * static_cast<double>(std::ranges::count(moved, true)), {}};
  for (std::size_t begin = 0; begin < moved.size();) {
    std::size_t end = begin;
    while (end < moved.size() && !moved[end]) ++end;
    // At the ends of motion, not at the ends of the recording.
    const std::size_t from = begin > 0 ? begin + kBesideMotion : begin;
    const std::size_t to = end < moved.size() ? end - std::min(end, kBesideMotion) : end;
    if (to > from && static_cast<double>(to - from) * window >= kLongEnough)
      rest.places.push_back({static_cast<double>(from) * window, static_cast<double>(to) * window});
    begin = end + 1;
  }
  return rest;
}

}  // namespace coast::noise
