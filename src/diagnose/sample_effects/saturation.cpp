#include <algorithm>
#include <cmath>

#include "sample_effects.hpp"

namespace coast::diagnose {

namespace {

constexpr double kEqual = 1e-9;  // of the limit: what files leave

/// Samples [first, last] in a row stand at the limit.
struct Episode {
  Eigen::Index first, last;
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

/// Whether an extreme is held as no signal with noise holds it: often, in a row, and far oftener than values just below.
bool is_held(const Eigen::ArrayXd& values, double extreme, double white_sd) {
  constexpr Eigen::Index kOften = 5;
  constexpr Eigen::Index kInARow = 3;
  constexpr Eigen::Index kMore = 2;
  const std::vector<Episode> held = episodes(values, extreme);
  Eigen::Index count = 0;
  Eigen::Index longest = 0;
  for (const Episode& e : held) {
    count += e.last - e.first + 1;
    longest = std::max(longest, e.last - e.first + 1);
  }
  if (count < kOften || longest < kInARow) return false;
  // Of rounded values the next step is as good as the limit itself.
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

/// Slope of the line through the values of [from, to).
double slope(const Eigen::ArrayXd& values, Eigen::Index from, Eigen::Index to) {
  const Eigen::Index n = to - from;
  if (n < 2) return 0.0;
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) - 0.5 * static_cast<double>(n - 1);
  return (x * values.segment(from, n)).sum() / x.square().sum();
}

/// Beyond the limit the signal is taken for the cubic that goes on with the slopes on either side; of its mean height a third
/// is the uncertainty of all of it together.
void mend(MissionInput& input, Site site, int axis, double limit) {
  constexpr Eigen::Index kSlope = 8;  // samples
  constexpr double kUncertain = 0.33;
  const AxisSeries series = axis_series(input, site, axis);
  const Eigen::Vector3d direction_b = input.setup.C_s_b.col(axis);
  std::vector<RaisedNoise> noise;
  for (const double side : {std::abs(limit), -std::abs(limit)}) {
    if (side != limit && !is_held(series.values, side, series.white_sd)) continue;
    const double sign = side > 0.0 ? 1.0 : -1.0;
    for (const Episode& e : episodes(series.values, side)) {
      const double up = std::max(0.0, sign * slope(series.values, std::max<Eigen::Index>(0, e.first - kSlope), e.first));
      const double down =
          std::max(0.0, -sign * slope(series.values, e.last + 1, std::min(series.values.size(), e.last + 1 + kSlope)));
      const auto length = static_cast<double>(e.last - e.first + 2);  // steps between the samples on either side
      double sum = 0.0;
      for (Eigen::Index i = e.first; i <= e.last; ++i) {
        const double s = static_cast<double>(i - e.first + 1) / length;
        const double height = length * (up * s * (1.0 - s) * (1.0 - s) + down * s * s * (1.0 - s));
        record::ImuSample& sample = input.imu.samples[static_cast<std::size_t>(i)];
        (site == Site::kGyro ? sample.dtheta : sample.dv) += sign * height * sample.dt * direction_b;
        sum += height;
      }
      const double mean = sum / static_cast<double>(e.last - e.first + 1);
      const record::ImuSample& first = input.imu.samples[static_cast<std::size_t>(e.first)];
      const geo::GpsTime to = input.imu.samples[static_cast<std::size_t>(e.last)].t;
      const geo::GpsTime from = first.t - first.dt;
      if (mean > 0.0) noise.push_back({from, to, kUncertain * kUncertain * mean * mean * (to - from)});
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
