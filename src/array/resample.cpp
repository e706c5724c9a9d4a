#include "coast/array/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "resampling_kernel.hpp"
#include "sampled_run.hpp"

namespace coast::array {

namespace {

/// Mean interval of the input over all of its runs.
double mean_interval(const std::vector<SampledRun>& runs) {
  double span = 0.0, count = 0.0;
  for (const SampledRun& run : runs) {
    span += run.edges.back() - run.edges.front();
    count += static_cast<double>(run.size());
  }
  return span / count;
}

double grid_over_input(const Grid& grid, const std::vector<SampledRun>& runs) {
  constexpr double kMostWidth = 1000.0;
  constexpr double kLeastWidth = 0.01;
  const double width = grid.dt / mean_interval(runs);
  if (!(width >= kLeastWidth && width <= kMostWidth))
    throw std::invalid_argument(
        fmt::format("dt = {} s, {} intervals of the recording, must be in [{}, {}]", grid.dt, width, kLeastWidth, kMostWidth));
  return width;
}

/// Position of an instant among the edges of a run, in intervals; instants are in order.
class Place {
 public:
  explicit Place(const std::vector<double>& edges) : edges_(edges) {}
  double operator()(double t) {
    while (k_ + 2 < edges_.size() && t >= edges_[k_ + 1]) ++k_;
    return static_cast<double>(k_) + (t - edges_[k_]) / (edges_[k_ + 1] - edges_[k_]);
  }

 private:
  const std::vector<double>& edges_;
  std::size_t k_ = 0;
};

void resample_run(const SampledRun& run, const Grid& grid, const ResamplingKernel& kernel, SensorSignals& result) {
  const double from = std::floor(run.edges.front() / grid.dt), to = std::ceil(run.edges.back() / grid.dt);
  const double samples = static_cast<double>(grid.samples);
  const auto first = static_cast<std::size_t>(std::clamp(from, 0.0, samples));
  const auto end = static_cast<std::size_t>(std::clamp(to, 0.0, samples));
  Place place(run.edges);
  double left = first < end ? place(grid.dt * static_cast<double>(first)) : 0.0;
  for (std::size_t n = first; n < end; ++n) {
    const double right = place(grid.dt * static_cast<double>(n + 1));
    const double centre = 0.5 * (left + right) - 0.5;  // in means: number i lies at i
    left = right;
    if (centre < -0.5 || centre > static_cast<double>(run.size()) - 0.5) continue;
    const auto lowest = static_cast<Eigen::Index>(std::ceil(centre - kernel.reach()));
    const auto highest = static_cast<Eigen::Index>(std::floor(centre + kernel.reach()));
    const Eigen::Index begin = std::max<Eigen::Index>(lowest, 0), last = std::min(highest, run.size() - 1);
    Channels sum = Channels::Zero();
    double weights = 0.0;
    for (Eigen::Index i = begin; i <= last; ++i) {
      const double weight = kernel(static_cast<double>(i) - centre);
      weights += weight;
      sum += weight * run.means.col(i);
    }
    const auto column = static_cast<Eigen::Index>(n);
    // Next to a gap at least half of the kernel is available, so its sum is not close to zero.
    result.values.col(column) = sum / weights;
    if (begin == lowest && last == highest) result.usable[n] = kAllUsable;
  }
}

}  // namespace

SensorSignals resample(const record::ImuRecording& recording, const Grid& grid, const LagOfTag& lag) {
  if (recording.samples.empty()) throw std::invalid_argument(fmt::format("{}: no samples", recording.source));
  if (!(grid.dt > 0.0) || !std::isfinite(grid.dt))
    throw std::invalid_argument(fmt::format("dt = {} s, must be above 0", grid.dt));
  const std::vector<SampledRun> runs = sampled_runs(recording, grid.start, lag);
  const ResamplingKernel kernel(grid_over_input(grid, runs));
  SensorSignals result;
  result.name = recording.source;
  result.values.setZero(kChannels, static_cast<Eigen::Index>(grid.samples));
  result.usable.assign(grid.samples, 0);
  for (const SampledRun& run : runs) resample_run(run, grid, kernel, result);
  return result;
}

}  // namespace coast::array
