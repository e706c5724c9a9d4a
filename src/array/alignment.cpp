#include "coast/array/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lag_spectra.hpp"
#include "robust_line.hpp"

namespace coast::array {

namespace {

constexpr double kLeastSignificance = 6.0;
constexpr Eigen::Index kFewestSamples = 200;

void validate_lag(const SensorSignals& reference, const SensorSignals& sensor, double dt, const LagOptions& options) {
  if (reference.values.cols() != sensor.values.cols())
    throw std::invalid_argument(
        fmt::format("{} columns of {}, {} of {}", reference.values.cols(), reference.name, sensor.values.cols(), sensor.name));
  if (!(dt > 0.0) || !std::isfinite(dt)) throw std::invalid_argument(fmt::format("dt = {} s, must be above 0", dt));
  if (!(options.max_lag_s > 0.0))
    throw std::invalid_argument(fmt::format("max_lag_s = {}, must be above 0", options.max_lag_s));
  if (!(options.window_s > 0.0)) throw std::invalid_argument(fmt::format("window_s = {}, must be above 0", options.window_s));
}

LagSamples rates_of(const SensorSignals& sensor, LagSignal of, Eigen::Index from, Eigen::Index count) {
  const auto rates = sensor.values.middleCols(from, count).topRows<3>();
  if (of == LagSignal::kNorm) return rates.colwise().norm().transpose();
  return rates.transpose();
}

/// Centre of the motion that determines the lag, in samples: weighted by squared changes, as products of both sensors' changes
/// so that noise cancels, over a quarter of a period.
double centre_of_motion(const LagSamples& a, const LagSamples& b, double omega) {
  const double quarter = 0.5 * M_PI / std::max(omega, 1e-6);
  const Eigen::Index step = std::clamp<Eigen::Index>(std::lround(quarter), 1, a.rows() / 10);
  double sum = 0.0, moment = 0.0;
  for (Eigen::Index i = step; i < a.rows(); ++i) {
    const double change = (a.row(i) - a.row(i - step)).dot(b.row(i) - b.row(i - step));
    sum += change;
    moment += change * (static_cast<double>(i) - 0.5 * static_cast<double>(step));
  }
  const double last = static_cast<double>(a.rows() - 1);
  return sum > 0.0 ? std::clamp(moment / sum, 0.0, last) : 0.5 * last;
}

/// Moves the sensor's window by integer samples until less than one is left.
struct Search {
  Eigen::Index moved = 0;
  FineLag fine;
};

std::optional<Search> settle(const LagSamples& a, const LagSamples& b, Eigen::Index most) {
  constexpr int kMoves = 6;
  Search search;
  search.moved = whole_lag(a, b, most);
  for (int move = 0; move < kMoves; ++move) {
    if (std::abs(search.moved) >= most) return {};
    search.fine = fine_lag(a, b.middleRows(most + search.moved, a.rows()));
    if (std::abs(search.fine.lag) <= 0.75) return search;
    search.moved += std::lround(search.fine.lag);
  }
  return search;
}

bool rates_usable(const SensorSignals& sensor, std::size_t n) {
  constexpr std::uint8_t kRates = 0x07;
  return (sensor.usable[n] & kRates) == kRates;
}

/// Stretches [first, second) where both sensors may be used.
std::vector<std::pair<std::size_t, std::size_t>> usable_stretches(const SensorSignals& a, const SensorSignals& b) {
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  const auto columns = static_cast<std::size_t>(a.values.cols());
  for (std::size_t n = 0; n < columns; ++n) {
    if (!rates_usable(a, n) || !rates_usable(b, n)) continue;
    if (stretches.empty() || stretches.back().second != n) stretches.emplace_back(n, n);
    ++stretches.back().second;
  }
  return stretches;
}

void fit_lag_line(LagCurve& curve) {
  if (curve.windows.size() == 1) {
    curve.offset_s = curve.windows[0].lag_s;
    curve.offset_sigma_s = curve.windows[0].sigma_s;
    curve.reference_s = curve.windows[0].at_s;
    curve.drift_sigma_ppm = std::numeric_limits<double>::infinity();
    curve.weights = {1.0};
    return;
  }
  std::vector<LinePoint> points;
  for (const Lag& lag : curve.windows) points.push_back({lag.at_s, lag.lag_s, lag.sigma_s});
  const RobustLine line = fit_line(points, curve.reference_s, Sigmas::kAbsolute);
  curve.offset_s = line.value;
  curve.offset_sigma_s = line.value_sigma;
  curve.drift_ppm = 1e6 * line.slope;
  curve.drift_sigma_ppm = 1e6 * line.slope_sigma;
  curve.scatter = line.scale;
  curve.weights = line.weights;
}

}  // namespace

LagEstimate find_lag(const SensorSignals& reference, const SensorSignals& sensor, double dt, std::size_t from,
                     std::size_t count, const LagOptions& options) {
  validate_lag(reference, sensor, dt, options);
  const auto columns = static_cast<std::size_t>(reference.values.cols());
  if (from > columns || count > columns - from)
    throw std::invalid_argument(fmt::format("columns {} to {} of {}", from, from + count, columns));
  const auto most = static_cast<Eigen::Index>(std::ceil(options.max_lag_s / dt)) + 1;
  const Eigen::Index first = static_cast<Eigen::Index>(from) + most, inner = static_cast<Eigen::Index>(count) - 2 * most;
  if (inner < kFewestSamples || inner < 2 * most)
    return {{}, fmt::format("{} samples are too few for lags up to {} s", count, options.max_lag_s)};

  LagSamples a = rates_of(reference, options.of, first, inner);
  LagSamples b = rates_of(sensor, options.of, first - most, inner + 2 * most);
  detrend(a);
  detrend(b);
  const std::optional<Search> found = settle(a, b, most);
  if (!found) return {{}, fmt::format("no correlation is largest within +-{} s", options.max_lag_s)};
  const FineLag& fine = found->fine;
  if (!(fine.significance >= kLeastSignificance))
    return {{}, fmt::format("too little motion: coherence {:.1f} sigmas above chance", fine.significance)};
  Lag lag;
  lag.lag_s = dt * (static_cast<double>(found->moved) + fine.lag);
  lag.sigma_s = dt * fine.sigma;
  const double centre = centre_of_motion(a, b.middleRows(most + found->moved, inner), fine.rms_frequency);
  lag.at_s = dt * (static_cast<double>(first) + 0.5 + centre);
  lag.coherence = fine.coherence;
  lag.bandwidth_hz = fine.rms_frequency / (2.0 * M_PI * dt);
  return {lag, {}};
}

std::optional<LagCurve> lag_curve(const SensorSignals& reference, const SensorSignals& sensor, double dt,
                                  const LagOptions& options) {
  validate_lag(reference, sensor, dt, options);
  LagCurve curve;
  curve.reference_s = 0.5 * dt * static_cast<double>(reference.values.cols());
  const std::vector<std::pair<std::size_t, std::size_t>> stretches = usable_stretches(reference, sensor);
  for (const auto& [from, to] : stretches) {
    const std::size_t length = to - from;
    const double windows = std::floor(static_cast<double>(length) * dt / options.window_s + 1e-9);
    if (windows < 1.0) {
      curve.left_out.push_back(
          fmt::format("{:.1f} s between gaps at {:.1f} s", static_cast<double>(length) * dt, static_cast<double>(from) * dt));
      continue;
    }
    const auto count = static_cast<std::size_t>(static_cast<double>(length) / windows);
    for (std::size_t start = from; start + count <= to; start += count) {
      LagEstimate estimate = find_lag(reference, sensor, dt, start, count, options);
      if (estimate.lag) curve.windows.push_back(*estimate.lag);
      if (!estimate.lag) curve.left_out.push_back(std::move(estimate.why_not));
    }
  }
  if (curve.windows.empty()) return {};
  fit_lag_line(curve);
  return curve;
}

}  // namespace coast::array
