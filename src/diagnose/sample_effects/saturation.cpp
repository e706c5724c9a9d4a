#include <algorithm>
#include <cmath>

#include "sample_effects.hpp"

namespace coast::diagnose {

namespace {

constexpr double kEqual = 1e-9;     // of the limit: rounding of files
constexpr Eigen::Index kApart = 8;  // samples

/// Consecutive samples [first, last] at the limit.
struct Episode {
  Eigen::Index first, last;
  [[nodiscard]] Eigen::Index length() const { return last - first + 1; }
};

std::vector<Episode> episodes(const Eigen::ArrayXd& values, double limit) {
  std::vector<Episode> result;
  const double sign = limit > 0.0 ? 1.0 : -1.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (sign * values(i) < std::abs(limit) * (1.0 - kEqual)) continue;
    if (!result.empty() && result.back().last == i - 1)
      result.back().last = i;
    else
      result.push_back({i, i});
  }
  return result;
}

/// Whether an extreme occurs as no noisy signal gives it: often, consecutively, and far more often than values just below.
bool is_held(const Eigen::ArrayXd& values, double extreme, double white_sd) {
  constexpr Eigen::Index kOften = 5;
  constexpr Eigen::Index kInARow = 3;
  constexpr Eigen::Index kMore = 2;
  const std::vector<Episode> held = episodes(values, extreme);
  Eigen::Index count = 0;
  Eigen::Index longest = 0;
  for (const Episode& e : held) {
    count += e.length();
    longest = std::max(longest, e.length());
  }
  if (count < kOften || longest < kInARow) return false;
  // For rounded values the next step counts as the limit.
  const Eigen::ArrayXd toward = (extreme > 0.0 ? 1.0 : -1.0) * values;
  const double at_limit = std::abs(extreme) * (1.0 - kEqual);
  const double next = (toward < at_limit).select(toward, -std::abs(extreme)).maxCoeff();
  const Eigen::Index near = (toward >= std::min(next, at_limit - white_sd)).count() - count;
  return count > kMore * near;
}

std::optional<double> find_limit(const AxisSeries& series) {
  if (series.values.size() < 100) return {};
  const double high = series.values.maxCoeff();
  const double low = series.values.minCoeff();
  if (high > 0.0 && is_held(series.values, high, series.white_sd)) return high;
  if (low < 0.0 && is_held(series.values, low, series.white_sd)) return low;
  return {};
}

/// Slope of the line through some values, per sample, and its variance from the residuals.
struct Slope {
  double value = 0.0;
  double variance = 0.0;
};
Slope slope_of(const Eigen::ArrayXd& values) {
  const auto n = static_cast<double>(values.size());
  if (values.size() < 3) return {};
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(values.size(), -0.5 * (n - 1.0), 0.5 * (n - 1.0));
  const double squares = x.square().sum();
  const double slope = (x * values).sum() / squares;
  const double rest = (values - values.mean() - slope * x).square().sum() / (n - 2.0);
  return {slope, rest / squares};
}

/// Slope with which the limit is reached. @param away  values from the limit on  @param longest  stretch in which the signal is
/// straight
Slope upward(const Eigen::ArrayXd& away, Eigen::Index longest) {
  constexpr double kSeen = 5.0;  // sd: the fewest values that give the slope this significance are used
  Slope slope;
  for (Eigen::Index n = kApart;; n *= 2) {
    const bool all = n >= std::min(longest, away.size());
    slope = slope_of(away.head(std::min({n, longest, away.size()})));
    if (all || slope.value * slope.value > kSeen * kSeen * slope.variance) break;
  }
  slope.value = std::max(0.0, -slope.value);
  return slope;
}

/// An excursion beyond the limit. Before and after it noise crosses the limit more than once: episodes close together.
struct Excursion {
  Eigen::Index first, last;
  Slope up, down;  ///< toward the limit on either side, at least zero
  [[nodiscard]] double steps() const { return static_cast<double>(last - first + 2); }
  /// The cubic between the samples on either side that continues their slopes.
  [[nodiscard]] double height(Eigen::Index i) const {
    const double s = static_cast<double>(i - first + 1) / steps();
    return steps() * (up.value * s * (1.0 - s) * (1.0 - s) + down.value * s * s * (1.0 - s));
  }
  [[nodiscard]] double mean() const { return steps() * (up.value + down.value) / 12.0; }
  /// Variance of its mean height: a third for its unknown shape, plus that from the slopes.
  [[nodiscard]] double variance() const {
    constexpr double kShape = 0.33;
    return std::pow(kShape * mean(), 2) + std::pow(steps() / 12.0, 2) * (up.variance + down.variance);
  }
};

/// From and to the signal's own crossings of the limit: there half of the surrounding samples are at the limit.
Excursion between_crossings(const Eigen::Array<bool, Eigen::Dynamic, 1>& held, Eigen::Index first, Eigen::Index last) {
  const Eigen::Index reach = std::min(kApart, (last - first + 1) / 4);
  const auto is_beyond = [&](Eigen::Index i) {
    const Eigen::Index from = std::max<Eigen::Index>(0, i - reach);
    const Eigen::Index count = std::min(held.size(), i + reach + 1) - from;
    return 2 * held.segment(from, count).count() >= count;
  };
  Excursion e{first, last, {}, {}};
  while (e.first < e.last && !is_beyond(e.first)) ++e.first;
  while (e.last > e.first && !is_beyond(e.last)) --e.last;
  return e;
}

/// @param toward  values with the sign for which the limit is the upper one
std::vector<Excursion> excursions(const Eigen::ArrayXd& toward, double limit) {
  const Eigen::Array<bool, Eigen::Dynamic, 1> held = toward >= limit * (1.0 - kEqual);
  std::vector<Episode> together;
  for (const Episode& e : episodes(toward, limit)) {
    const auto apart = [&](const Episode& before) {
      return e.first - before.last > std::max({kApart, before.length() / 4, e.length() / 4});
    };
    if (together.empty() || apart(together.back()))
      together.push_back(e);
    else
      together.back().last = e.last;
  }
  std::vector<Excursion> result;
  for (const Episode& e : together) result.push_back(between_crossings(held, e.first, e.last));
  for (std::size_t k = 0; k < result.size(); ++k) {
    Excursion& e = result[k];
    const Eigen::Index longest = std::max(kApart, (e.last - e.first + 1) / 4);
    const Eigen::Index before = e.first - (k > 0 ? result[k - 1].last + 1 : 0);
    const Eigen::Index behind = (k + 1 < result.size() ? result[k + 1].first : toward.size()) - e.last - 1;
    e.up = upward(toward.segment(e.first - before, before).reverse(), longest);
    e.down = upward(toward.segment(e.last + 1, behind), longest);
  }
  return result;
}

/// Beyond the limit the signal is assumed to be a cubic; its possible error is added as noise.
void mend(MissionInput& input, Site site, int axis, double limit) {
  const AxisSeries series = axis_series(input, site, axis);
  const Eigen::Vector3d direction_b = input.setup.C_s_b.col(axis);
  std::vector<RaisedNoise> noise;
  for (const double side : {std::abs(limit), -std::abs(limit)}) {
    if (side != limit && !is_held(series.values, side, series.white_sd)) continue;
    const double sign = side > 0.0 ? 1.0 : -1.0;
    const Eigen::ArrayXd toward = sign * series.values;
    for (const Excursion& e : excursions(toward, std::abs(limit))) {
      for (Eigen::Index i = e.first; i <= e.last; ++i) {
        if (toward(i) < std::abs(limit) * (1.0 - kEqual)) continue;
        record::ImuSample& sample = input.imu.samples[static_cast<std::size_t>(i)];
        (site == Site::kGyro ? sample.dtheta : sample.dv) += sign * e.height(i) * sample.dt * direction_b;
      }
      const record::ImuSample& first = input.imu.samples[static_cast<std::size_t>(e.first)];
      const geo::GpsTime from = first.t - first.dt;
      const geo::GpsTime to = input.imu.samples[static_cast<std::size_t>(e.last)].t;
      if (e.variance() > 0.0) noise.push_back({from, to, e.variance() * (to - from)});
    }
  }
  std::ranges::sort(noise, {}, &RaisedNoise::from);
  raise_noise(input, site, axis, noise);
}

}  // namespace

SampleEffect saturation(Site site) {
  return {
      .name = "saturation",
      .site = site,
      .parameter = "limit",
      .unit = site == Site::kGyro ? "rad/s" : "m/s^2",
      .equation = "measured = min(signal, limit)",
      .meaning = "The signal went beyond what the sensor can measure.",
      .separating_manoeuvre = "None is needed: the samples stand at the limit. A gentler drive avoids it.",
      .source = "IEEE Std 528-2019, input range",
      .find = find_limit,
      .model = mend,
  };
}

}  // namespace coast::diagnose
