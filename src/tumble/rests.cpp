#include "coast/tumble/rests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "coast/record/error.hpp"

namespace coast::tumble {

namespace {

using Axes = Eigen::Array<double, 6, 1>;

constexpr double kQuarter = 0.25;      ///< s
constexpr double kMostVariance = 8.0;  ///< of a quiet quarter over the baseline; a hand has hundreds
constexpr double kMostChange = 6.0;    ///< of its mean, in standard deviations

struct Quarter {
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
  Axes mean;
  Axes variance;
  bool whole = true;  ///< no sample is missing
  bool quiet = false;
};

Axes rate_of(const record::ImuSample& sample) {
  Axes axes;
  axes << sample.dtheta.array(), sample.dv.array();
  return axes / sample.dt;
}

double median_step(const std::vector<record::ImuSample>& samples) {
  std::vector<double> steps;
  steps.reserve(samples.size());
  for (const record::ImuSample& sample : samples) steps.push_back(sample.dt);
  std::ranges::nth_element(steps, steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2));
  return steps[steps.size() / 2];
}

std::vector<Quarter> quarters_of(const record::ImuRecording& sensor) {
  const double step = median_step(sensor.samples);
  const auto length = static_cast<std::size_t>(std::max(5.0, std::round(kQuarter / step)));
  std::vector<Quarter> quarters;
  for (std::size_t first = 0; first + length <= sensor.samples.size(); first += length) {
    Quarter& quarter = quarters.emplace_back(Quarter{first, first + length - 1, Axes::Zero(), Axes::Zero()});
    for (std::size_t i = first; i <= quarter.last; ++i) {
      quarter.mean += rate_of(sensor.samples[i]);
      quarter.whole = quarter.whole && sensor.samples[i].dt < 1.5 * step;
    }
    quarter.mean /= static_cast<double>(length);
    for (std::size_t i = first; i <= quarter.last; ++i)
      quarter.variance += (rate_of(sensor.samples[i]) - quarter.mean).square();
    quarter.variance /= static_cast<double>(length - 1);
  }
  return quarters;
}

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

// Variance of white rounding noise of the smallest step between samples: below it a quiet axis may repeat one value.
Axes rounding_variance(const record::ImuRecording& sensor) {
  Axes smallest = Axes::Constant(std::numeric_limits<double>::infinity());
  Axes before = rate_of(sensor.samples.front());
  for (const record::ImuSample& sample : sensor.samples) {
    const Axes now = rate_of(sample);
    const Axes step = (now - before).abs();
    // Steps within the rounding of doubles are none.
    const Axes least = 1e-9 * now.abs().max(before.abs()) + 1e-15;
    smallest = (step > least).select(smallest.min(step), smallest);
    before = now;
  }
  return smallest.isFinite().select(smallest.square() / 12.0, 0.0);
}

void mark_quiet(std::vector<Quarter>& quarters, const Axes& rounding) {
  Axes baseline;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    std::vector<double> variances;
    for (const Quarter& quarter : quarters) variances.push_back(quarter.variance[axis]);
    baseline[axis] = std::max(quantile(std::move(variances), 0.1), rounding[axis]);
  }
  for (Quarter& quarter : quarters) quarter.quiet = quarter.whole && (quarter.variance <= kMostVariance * baseline).all();
  Axes change;  // standard deviation of the difference of two quarters
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    std::vector<double> differences{std::sqrt(rounding[axis])};
    for (std::size_t i = 1; i < quarters.size(); ++i)
      if (quarters[i].quiet && quarters[i - 1].quiet)
        differences.push_back(std::abs(quarters[i].mean[axis] - quarters[i - 1].mean[axis]));
    change[axis] = std::max(quantile(std::move(differences), 0.5) / 0.6745, std::sqrt(rounding[axis]));
  }
  std::vector<bool> steady(quarters.size(), true);
  for (std::size_t i = 1; i < quarters.size(); ++i)
    if (((quarters[i].mean - quarters[i - 1].mean).abs() > kMostChange * change).any()) steady[i] = steady[i - 1] = false;
  for (std::size_t i = 0; i < quarters.size(); ++i) quarters[i].quiet = quarters[i].quiet && steady[i];
}

/// Quarters [first, last] of one rest.
struct Run {
  std::size_t first;
  std::size_t last;
};

// The first and the last quarter of a rest may hold the end of a movement.
std::vector<Run> runs_of(const std::vector<Quarter>& quarters, std::size_t least) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < quarters.size();) {
    std::size_t end = i;
    while (end < quarters.size() && quarters[end].quiet) ++end;
    const std::size_t first = i == 0 ? 0 : i + 1;
    const std::size_t last = end == quarters.size() ? end : end - (end > i ? 1 : 0);
    if (last >= first + least) runs.push_back({first, last - 1});
    i = std::max(end, i + 1);
  }
  return runs;
}

Rest rest_from(const record::ImuRecording& sensor, const std::vector<Quarter>& quarters, const Run& run) {
  Rest rest;
  rest.first = quarters[run.first].first;
  rest.last = quarters[run.last].last;
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double time = 0.0;
  for (std::size_t i = rest.first; i <= rest.last; ++i) {
    angle += sensor.samples[i].dtheta;
    velocity += sensor.samples[i].dv;
    time += sensor.samples[i].dt;
  }
  rest.gyro = angle / time;
  rest.accel = velocity / time;
  rest.to = sensor.samples[rest.last].t - sensor.samples.front().t + sensor.samples.front().dt;
  rest.from = rest.to - time;
  return rest;
}

}  // namespace

std::vector<Rest> find_rests(const record::ImuRecording& sensor, double min_duration) {
  std::vector<Quarter> quarters = quarters_of(sensor);
  if (quarters.size() < 8) throw InputError({sensor.source, 0, "fewer than two seconds of samples", "rests in many poses", ""});
  const Axes rounding = rounding_variance(sensor);
  mark_quiet(quarters, rounding);
  const double length = static_cast<double>(quarters.front().last + 1) * median_step(sensor.samples);
  const std::vector<Run> runs = runs_of(quarters, static_cast<std::size_t>(std::max(2.0, std::ceil(min_duration / length))));
  // Scatter of a quarter's mean within a rest, pooled over all rests.
  Axes scatter = Axes::Zero();
  double freedom = 0.0;
  std::vector<Rest> rests;
  for (const Run& run : runs) {
    const Rest& rest = rests.emplace_back(rest_from(sensor, quarters, run));
    Axes mean;
    mean << rest.gyro.array(), rest.accel.array();
    for (std::size_t i = run.first; i <= run.last; ++i) scatter += (quarters[i].mean - mean).square();
    freedom += static_cast<double>(run.last - run.first);
  }
  if (rests.empty()) return rests;
  scatter = (scatter / freedom).max(rounding / static_cast<double>(quarters.front().last + 1));
  for (std::size_t i = 0; i < rests.size(); ++i) {
    const auto count = static_cast<double>(runs[i].last - runs[i].first + 1);
    rests[i].gyro_variance = scatter.head<3>() / count;
    rests[i].accel_variance = scatter.tail<3>() / count;
  }
  return rests;
}

}  // namespace coast::tumble
