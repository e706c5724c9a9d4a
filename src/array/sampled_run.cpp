#include "sampled_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace coast::array {

namespace {

constexpr std::size_t kSmoothed = 32;  // tags to both sides: a clock is assumed linear over these
constexpr std::size_t kNodes = 3;      // tags to both sides used for interpolation of increments
constexpr double kGap = 1.5;           // intervals
constexpr double kExact = 2e-6;        // of an interval: the rounding of tags to 1 ns

/// Increments of one stretch before division by their intervals.
struct RawRun {
  std::vector<double> tags;  ///< corrected; one more than increments
  std::vector<Channels> increments;
};

double corrected(geo::GpsTime tag, geo::GpsTime origin, const LagOfTag& lag) {
  return (tag - origin) - (lag ? lag(tag) : 0.0);
}

double median_interval(const record::ImuRecording& recording) {
  std::vector<double> intervals;
  intervals.reserve(recording.samples.size());
  for (const record::ImuSample& sample : recording.samples) intervals.push_back(sample.dt);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// A sample over a long interval is a gap, too: the motion within it is unknown.
std::vector<RawRun> raw_runs(const record::ImuRecording& recording, geo::GpsTime origin, const LagOfTag& lag) {
  const double longest = kGap * median_interval(recording);
  std::vector<RawRun> runs;
  const record::ImuSample* before = nullptr;
  for (const record::ImuSample& sample : recording.samples) {
    const bool gap = before == nullptr || sample.t - before->t > longest;
    before = &sample;
    if (gap && sample.dt > longest) {
      runs.emplace_back().tags.push_back(corrected(sample.t, origin, lag));
      continue;
    }
    if (gap) runs.emplace_back().tags.push_back(corrected(sample.t - sample.dt, origin, lag));
    RawRun& run = runs.back();
    const double tag = corrected(sample.t, origin, lag);
    if (!(tag > run.tags.back()))
      throw std::invalid_argument(fmt::format("{}: corrected time {} s after {} s from the grid's start, must increase",
                                              recording.source, tag, run.tags.back()));
    run.tags.push_back(tag);
    run.increments.emplace_back();
    run.increments.back() << sample.dtheta, sample.dv;
  }
  std::erase_if(runs, [](const RawRun& run) { return run.increments.empty(); });
  return runs;
}

/// Means over 65 neighbours, fewer towards the ends.
std::vector<double> moving_mean(const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<double> sums(n + 1, 0.0), means(n);
  for (std::size_t k = 0; k < n; ++k) sums[k + 1] = sums[k] + values[k];
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t half = std::min({kSmoothed, k, n - 1 - k});
    means[k] = (sums[k + half + 1] - sums[k - half]) / static_cast<double>(2 * half + 1);
  }
  return means;
}

/// Tags without jitter: even spacing plus twice the moving mean of the remainder, so that adjacent intervals hardly differ.
std::vector<double> smoothed(const std::vector<double>& tags) {
  const std::size_t n = tags.size();
  const double interval = (tags.back() - tags.front()) / static_cast<double>(n - 1);
  std::vector<double> uneven(n), smooth(n);
  for (std::size_t k = 0; k < n; ++k) uneven[k] = tags[k] - tags.front() - interval * static_cast<double>(k);
  const std::vector<double> slow = moving_mean(moving_mean(uneven));
  for (std::size_t k = 0; k < n; ++k) {
    smooth[k] = tags[k] + (slow[k] - uneven[k]);
    if (k > 0 && !(smooth[k] > smooth[k - 1])) return tags;  // jitter too large to find the clock
  }
  return smooth;
}

/// Integral from tag k to `instant`, by the polynomial through the cumulative increments at the surrounding tags.
Channels integral_from_tag(const RawRun& run, std::size_t k, double instant) {
  std::array<Channels, 2 * kNodes + 1> cumulative;
  cumulative[kNodes].setZero();
  for (std::size_t j = 0; j < kNodes; ++j) {
    cumulative[kNodes + j + 1] = cumulative[kNodes + j] + run.increments[k + j];
    cumulative[kNodes - j - 1] = cumulative[kNodes - j] - run.increments[k - j - 1];
  }
  const double* tags = &run.tags[k - kNodes];
  Channels sum = Channels::Zero();
  for (std::size_t j = 0; j < cumulative.size(); ++j) {
    double weight = 1.0;
    for (std::size_t i = 0; i < cumulative.size(); ++i)
      if (i != j) weight *= (instant - tags[i]) / (tags[j] - tags[i]);
    sum += weight * cumulative[j];
  }
  return sum;
}

SampledRun on_smooth_times(RawRun run) {
  const std::size_t n = run.increments.size();
  SampledRun result;
  result.edges = smoothed(run.tags);
  const double exact = kExact * (run.tags.back() - run.tags.front()) / static_cast<double>(n);
  Channels moved_before = Channels::Zero();
  result.means.resize(kChannels, static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k <= n; ++k) {
    Channels moved = Channels::Zero();
    const bool inside = k >= kNodes && k + kNodes <= n;
    if (!inside) result.edges[k] = run.tags[k];
    if (inside && std::abs(result.edges[k] - run.tags[k]) > exact) moved = integral_from_tag(run, k, result.edges[k]);
    if (k > 0)
      result.means.col(static_cast<Eigen::Index>(k - 1)) =
          (run.increments[k - 1] + moved - moved_before) / (result.edges[k] - result.edges[k - 1]);
    moved_before = moved;
  }
  return result;
}

}  // namespace

std::vector<SampledRun> sampled_runs(const record::ImuRecording& recording, geo::GpsTime origin, const LagOfTag& lag) {
  std::vector<RawRun> raw = raw_runs(recording, origin, lag);
  std::vector<SampledRun> runs;
  for (RawRun& run : raw) runs.push_back(on_smooth_times(std::move(run)));
  return runs;
}

}  // namespace coast::array
