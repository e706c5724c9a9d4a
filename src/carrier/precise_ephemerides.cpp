#include <algorithm>
#include <array>

#include "coast/carrier/orbits.hpp"
#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

using record::ClockPoint;
using record::OrbitPoint;

constexpr std::size_t kPoints = 10;

/// Value and slope at x of the polynomial through the points (Newton's divided differences).
struct Interpolated {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
};

Interpolated interpolate(const OrbitPoint* points, geo::GpsTime t) {
  std::array<double, kPoints> x{};
  std::array<Eigen::Vector3d, kPoints> coefficients;
  for (std::size_t i = 0; i < kPoints; ++i) {
    x.at(i) = points[i].t - t;
    coefficients.at(i) = points[i].r_e;
  }
  for (std::size_t order = 1; order < kPoints; ++order)
    for (std::size_t i = kPoints - 1; i >= order; --i)
      coefficients.at(i) = (coefficients.at(i) - coefficients.at(i - 1)) / (x.at(i) - x.at(i - order));
  Interpolated at;
  for (std::size_t i = kPoints; i-- > 0;) {  // Horner at zero
    at.slope = at.value - x.at(i) * at.slope;
    at.value = coefficients.at(i) - x.at(i) * at.value;
  }
  return at;
}

/// The points around t if they are equally spaced.
const OrbitPoint* around(const std::vector<OrbitPoint>& points, geo::GpsTime t) {
  constexpr double kUneven = 1.5;
  if (points.size() < kPoints || t < points.front().t || t > points.back().t) return nullptr;
  const auto next = std::ranges::lower_bound(points, t, {}, &OrbitPoint::t) - points.begin();
  const auto half = static_cast<std::ptrdiff_t>(kPoints / 2);
  const auto last = static_cast<std::ptrdiff_t>(points.size() - kPoints);
  const OrbitPoint* first = &points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(next - half, 0, last))];
  double least = first[1].t - first[0].t, most = least;
  for (std::size_t i = 1; i + 1 < kPoints; ++i) {
    const double step = first[i + 1].t - first[i].t;
    least = std::min(least, step);
    most = std::max(most, step);
  }
  return most > kUneven * least ? nullptr : first;
}

/// Clock and its rate between two points at most `longest` apart.
template <class Point, class Clock>
std::optional<std::pair<double, double>> linear(const std::vector<Point>& points, geo::GpsTime t, double longest,
                                                const Clock& clock) {
  const auto next = std::ranges::lower_bound(points, t, {}, &Point::t);
  if (next == points.end() || (next == points.begin() && next->t != t)) return {};
  const auto before = next == points.begin() ? next : std::prev(next);
  const auto after = next == points.begin() ? std::next(next) : next;
  if (after == points.end() || after->t - before->t > longest) return {};
  const std::optional<double> a = clock(*before), b = clock(*after);
  if (!a || !b) return {};
  const double rate = (*b - *a) / (after->t - before->t);
  return std::pair(*a + rate * (t - before->t), rate);
}

}  // namespace

PreciseEphemerides::PreciseEphemerides(record::PreciseOrbits orbits, record::PreciseClocks clocks)
    : orbits_(std::move(orbits)), clocks_(std::move(clocks)) {}

std::optional<SatelliteState> PreciseEphemerides::at(record::Satellite satellite, geo::GpsTime t) const {
  constexpr double kLongestClock = 330.0, kLongestOrbitClock = 930.0;  // s: clock files have 5 min or less, orbit files 15
  const auto found = orbits_.points.find(satellite);
  if (found == orbits_.points.end()) return std::nullopt;
  const OrbitPoint* points = around(found->second, t);
  if (points == nullptr) return std::nullopt;
  std::optional<std::pair<double, double>> clock;
  if (const auto own = clocks_.points.find(satellite); own != clocks_.points.end())
    clock = linear(own->second, t, kLongestClock, [](const ClockPoint& p) { return std::optional(p.clock_s); });
  if (!clock) clock = linear(found->second, t, kLongestOrbitClock, [](const OrbitPoint& p) { return p.clock_s; });
  if (!clock) return std::nullopt;
  const Interpolated at = interpolate(points, t);
  SatelliteState state;
  state.r_e = at.value;
  state.v_e = at.slope;
  // -2 r.v / c^2 is the same in ECEF: omega x r is perpendicular to r.
  state.clock_s = clock->first - 2.0 * at.value.dot(at.slope) / (kSpeedOfLight * kSpeedOfLight);
  state.clock_rate = clock->second;
  return state;
}

}  // namespace coast::carrier
