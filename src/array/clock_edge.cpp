// The lower edge of arrival - device as function of device: the clock without the delays.
#include "clock_edge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "linear_spline.hpp"

namespace coast::array {

namespace {

constexpr std::size_t kFewestOfClock = 60;
constexpr std::size_t kFewestInBlock = 20;

double delay_quantile(std::vector<double>& values, double quantile) {
  const auto at = static_cast<std::size_t>(std::lround(quantile * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

void validate_clock(const std::vector<double>& device_s, const std::vector<double>& arrival_s, const ClockOptions& options) {
  if (device_s.size() != arrival_s.size())
    throw std::invalid_argument(fmt::format("{} device times, {} arrivals", device_s.size(), arrival_s.size()));
  if (device_s.size() < kFewestOfClock)
    throw std::invalid_argument(fmt::format("{} packets of a clock, must be {} or more", device_s.size(), kFewestOfClock));
  if (!(options.quantile > 0.0 && options.quantile <= 0.5))
    throw std::invalid_argument(fmt::format("quantile = {}, must be in (0, 0.5]", options.quantile));
  if (!(options.block_s > 0.0) || !(options.knot_s > 0.0))
    throw std::invalid_argument(fmt::format("block_s = {}, knot_s = {}, must be above 0", options.block_s, options.knot_s));
  for (std::size_t i = 0; i < device_s.size(); ++i) {
    if (!std::isfinite(device_s[i]) || !std::isfinite(arrival_s[i]) || (i > 0 && device_s[i] <= device_s[i - 1]))
      throw std::invalid_argument(fmt::format("packet {} at {} s by the device, arrived {} s: not finite or not increasing", i,
                                              device_s[i], arrival_s[i]));
  }
}

/// The packets of one clock, divided into blocks.
class LowerEdge {
 public:
  LowerEdge(const std::vector<double>& device_s, const std::vector<double>& arrival_s, const ClockOptions& options)
      : device_(device_s), arrival_(arrival_s), options_(options) {
    const double span = device_s.back() - device_s.front();
    // Eight blocks of a short record, but each with enough packets for a quantile.
    const double shortest = span * static_cast<double>(kFewestInBlock) / static_cast<double>(device_s.size() - 1);
    block_s_ = std::max(std::min(options.block_s, span / 8.0), 1.0001 * shortest);
  }

  /// One point per block: its quantile of the values above `curve`, added to `curve`. Drift within a block would smear
  /// the quantile, so `curve` is the best known clock.
  template <class Curve>
  [[nodiscard]] std::vector<LinePoint> points(const Curve& curve) const {
    std::vector<LinePoint> points;
    std::vector<double> late;
    for (std::size_t i = 0; i < device_.size();) {
      const double end = device_[i] + block_s_;
      late.clear();
      double sum = 0.0;
      for (; i < device_.size() && device_[i] < end; ++i) {
        late.push_back(arrival_[i] - device_[i] - curve(device_[i]));
        sum += device_[i] - end;
      }
      if (late.size() < kFewestInBlock / 2) continue;  // before a gap
      const double x = end + sum / static_cast<double>(late.size());
      const double sigma = 1.0 / std::sqrt(static_cast<double>(late.size()));
      points.push_back({x, curve(x) + delay_quantile(late, options_.quantile), sigma});
    }
    return points;
  }

  template <class Curve>
  [[nodiscard]] std::vector<double> residuals(const Curve& curve) const {
    std::vector<double> late;
    late.reserve(device_.size());
    for (std::size_t i = 0; i < device_.size(); ++i) late.push_back(arrival_[i] - device_[i] - curve(device_[i]));
    return late;
  }

  /// At blocks, spaced as requested; the last piece is between 0.5 and 1.5 times as long.
  [[nodiscard]] std::vector<double> knots(const std::vector<LinePoint>& points) const {
    std::vector<double> knots{points.front().x};
    for (const LinePoint& point : points)
      if (point.x >= knots.back() + options_.knot_s && point.x <= points.back().x - 0.5 * options_.knot_s)
        knots.push_back(point.x);
    knots.push_back(points.back().x);
    return knots;
  }

 private:
  const std::vector<double>& device_;
  const std::vector<double>& arrival_;
  const ClockOptions& options_;
  double block_s_ = 0.0;
};

ClockCurve clock_curve_of(const LinearSpline& spline) {
  std::vector<ClockCurve::Knot> knots;
  for (std::size_t k = 0; k < spline.knots.size(); ++k) knots.push_back({spline.knots[k], spline.values[k], spline.sigmas[k]});
  return ClockCurve(std::move(knots));
}

ClockCurve clock_curve_of(const RobustLine& line, double from, double to) {
  const auto sigma = [&](double x) { return std::hypot(line.value_sigma, line.slope_sigma * (x - line.reference)); };
  return ClockCurve({{from, line.at(from), sigma(from)}, {to, line.at(to), sigma(to)}});
}

}  // namespace

void describe_clock(const RobustLine& line, std::vector<double> residuals, ClockFit& fit) {
  fit.offset_s = line.value;
  fit.offset_sigma_s = line.value_sigma;
  fit.drift_ppm = 1e6 * line.slope;
  fit.drift_sigma_ppm = 1e6 * line.slope_sigma;
  fit.residuals.count = residuals.size();
  fit.residuals.median = delay_quantile(residuals, 0.5);
  fit.residuals.percentile95 = delay_quantile(residuals, 0.95);
  const auto [least, most] = std::minmax_element(residuals.begin(), residuals.end());
  fit.residuals.minimum = *least;
  fit.residuals.maximum = *most;
}

ClockFit fit_clock(const std::vector<double>& device_s, const std::vector<double>& arrival_s, const ClockOptions& options) {
  constexpr int kPasses = 3;  // the drift that smeared the blocks of one pass is corrected in the next
  validate_clock(device_s, arrival_s, options);
  const LowerEdge edge(device_s, arrival_s, options);
  const double span = device_s.back() - device_s.front();
  ClockFit fit;
  fit.reference_s = 0.5 * (device_s.front() + device_s.back());

  RobustLine line;
  line.reference = fit.reference_s;
  std::vector<LinePoint> points;
  for (int pass = 0; pass < kPasses; ++pass) {
    points = edge.points([&](double x) { return line.at(x); });
    if (points.size() < 3) throw std::invalid_argument(fmt::format("{} blocks of packets, must be 3 or more", points.size()));
    line = fit_line(points, fit.reference_s, Sigmas::kRelative);
  }
  fit.curve = clock_curve_of(line, device_s.front(), device_s.back());
  if (span >= 3.0 * options.knot_s)
    for (int pass = 1; pass < kPasses; ++pass) {
      if (pass > 1) points = edge.points([&](double x) { return fit.curve.time(x) - x; });
      fit.curve = clock_curve_of(fit_spline(points, edge.knots(points)));
    }
  describe_clock(line, edge.residuals([&](double x) { return fit.curve.time(x) - x; }), fit);
  return fit;
}

}  // namespace coast::array
