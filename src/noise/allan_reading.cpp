// The classical coefficients, read from the slopes of a curve.

#include <algorithm>
#include <cmath>

#include "allan_curve.hpp"
#include "coast/geo/units.hpp"

namespace coast::noise {

namespace {

constexpr double kSlopeTolerance = 0.1;
constexpr double kShortestStretch = 2.0;  // tau_to / tau_from
constexpr double kSteepestFloor = -0.25;  // half-way to white noise

/// sigma = coefficient * factor * tau^slope.
struct Law {
  double slope;
  double factor;
};

struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;  ///< one past the last
  [[nodiscard]] double ratio(const AllanCurve& curve) const {
    return end > begin ? curve[end - 1].tau / curve[begin].tau : 0.0;
  }
};

Stretch longest_stretch(const AllanCurve& curve, double nominal) {
  Stretch longest;
  Stretch now;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const auto slope = curve[i].identified ? local_slope(curve, i) : std::nullopt;
    if (!slope || std::abs(*slope - nominal) > kSlopeTolerance) now.begin = i + 1;
    now.end = i + 1;
    if (now.ratio(curve) > longest.ratio(curve)) longest = now;
  }
  return longest;
}

/// Least-squares slope over a stretch, all points with equal weight.
double slope_of(const AllanCurve& curve, const Stretch& stretch) {
  double mean_x = 0.0;
  double mean_y = 0.0;
  const auto n = static_cast<double>(stretch.end - stretch.begin);
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    mean_x += std::log(curve[i].tau) / n;
    mean_y += std::log(curve[i].allan.value) / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    const double x = std::log(curve[i].tau) - mean_x;
    xx += x * x;
    xy += x * (std::log(curve[i].allan.value) - mean_y);
  }
  return xy / xx;
}

/// The interval of the stretch's value is that of its best point, scaled to the value.
void scale_intervals(CoefficientReading& reading, const Deviation& best) {
  const double ratio = reading.value / best.value;
  reading.interval_68 = {best.interval_68.lower * ratio, best.interval_68.upper * ratio};
  reading.interval_95 = {best.interval_95.lower * ratio, best.interval_95.upper * ratio};
}

std::optional<CoefficientReading> read_slope(const AllanCurve& curve, const Law& law) {
  const Stretch stretch = longest_stretch(curve, law.slope);
  if (stretch.ratio(curve) < kShortestStretch) return {};
  CoefficientReading reading{.tau_from = curve[stretch.begin].tau, .tau_to = curve[stretch.end - 1].tau};
  double weights = 0.0;
  double logarithm = 0.0;
  const Deviation* best = &curve[stretch.begin].allan;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    const AllanPoint& point = curve[i];
    weights += point.allan.edf;
    logarithm += point.allan.edf * (std::log(point.allan.value) - law.slope * std::log(point.tau));
    if (point.allan.edf > best->edf) best = &point.allan;
  }
  reading.value = std::exp(logarithm / weights) / law.factor;
  reading.slope = slope_of(curve, stretch);
  scale_intervals(reading, *best);
  return reading;
}

std::optional<CoefficientReading> read_floor(const AllanCurve& curve) {
  const auto end = std::ranges::find(curve, false, &AllanPoint::identified);
  if (end - curve.begin() < 3) return {};
  const auto lowest = std::min_element(curve.begin(), end,
                                       [](const AllanPoint& a, const AllanPoint& b) { return a.allan.value < b.allan.value; });
  if (lowest == curve.begin() || lowest + 1 == end) return {};
  const auto slope = local_slope(curve, static_cast<std::size_t>(lowest - curve.begin()));
  if (!slope || *slope < kSteepestFloor) return {};
  // IEEE Std 952-1997 annex C: the floor of flicker noise is at sqrt(2 ln 2 / pi) B.
  CoefficientReading reading{.value = lowest->allan.value / std::sqrt(2.0 * std::log(2.0) / geo::kPi),
                             .tau_from = lowest->tau,
                             .tau_to = lowest->tau,
                             .slope = *slope};
  scale_intervals(reading, lowest->allan);
  return reading;
}

}  // namespace

AllanReading read_coefficients(const AllanCurve& curve) {
  AllanReading reading;
  reading.quantisation = read_slope(curve, {.slope = -1.0, .factor = std::sqrt(3.0)});
  reading.white_noise = read_slope(curve, {.slope = -0.5, .factor = 1.0});
  reading.bias_instability = read_floor(curve);
  reading.rate_random_walk = read_slope(curve, {.slope = 0.5, .factor = std::sqrt(1.0 / 3.0)});
  reading.rate_ramp = read_slope(curve, {.slope = 1.0, .factor = std::sqrt(0.5)});
  return reading;
}

}  // namespace coast::noise
