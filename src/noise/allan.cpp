#include "coast/noise/allan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "allan_curve.hpp"

namespace coast::noise {

/// A record that may still be short enough for full overlap is kept; a longer one is held only in the pyramid.
struct AllanAccumulator::Sums {
  std::vector<AveragingFactor> factors;
  std::uint64_t full_overlap_samples;
  std::vector<double> kept;         ///< each run after one 0, the first point of its integral
  std::vector<std::size_t> starts;  ///< of the runs in `kept`
  bool in_run = false;
  std::optional<DifferencePyramid> pyramid;

  [[nodiscard]] std::span<double> run(std::size_t i) {
    const std::size_t end = i + 1 < starts.size() ? starts[i + 1] : kept.size();
    return std::span(kept).subspan(starts[i], end - starts[i]);
  }
  void keep(std::span<const double> samples) {
    if (!in_run) {
      starts.push_back(kept.size());
      kept.push_back(0.0);
    }
    in_run = true;
    kept.insert(kept.end(), samples.begin(), samples.end());
  }
  void end_run() {
    in_run = false;
    if (pyramid) pyramid->end_run();
  }
  void become_pyramid() {
    pyramid.emplace(factors);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      pyramid->add(run(i).subspan(1));
      if (i + 1 < starts.size() || !in_run) pyramid->end_run();
    }
    kept = {};
    starts = {};
  }
  [[nodiscard]] std::vector<DifferenceSums> full_overlap() {
    std::vector<DifferenceSums> sums(factors.size());
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const std::span<double> x = run(i);
      const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size() - 1);
      for (std::size_t j = 1; j < x.size(); ++j) x[j] += x[j - 1] - mean;
      for (std::size_t j = 0; j < factors.size() && 2 * factors[j].samples() < x.size(); ++j)
        add_differences(x, 1, factors[j].samples(), sums[j]);
    }
    return sums;
  }
};

AllanAccumulator::AllanAccumulator(double interval, const AllanOptions& options)
    : interval_(interval), sums_(std::make_unique<Sums>()) {
  if (!(interval > 0.0) || !std::isfinite(interval))
    throw std::invalid_argument(fmt::format("AllanAccumulator: interval = {} s, expected > 0", interval));
  if (options.points_per_decade < 1)
    throw std::invalid_argument(
        fmt::format("AllanAccumulator: points_per_decade = {}, expected 1 or more", options.points_per_decade));
  sums_->factors = averaging_factors(options.points_per_decade);
  sums_->full_overlap_samples = options.full_overlap_samples;
}

AllanAccumulator::~AllanAccumulator() = default;
AllanAccumulator::AllanAccumulator(AllanAccumulator&&) noexcept = default;
AllanAccumulator& AllanAccumulator::operator=(AllanAccumulator&&) noexcept = default;

void AllanAccumulator::flush() {
  const std::span<const double> samples(pending_.data(), pending_count_);
  if (samples.empty()) return;
  const auto bad = std::ranges::find_if_not(samples, [](double sample) { return std::isfinite(sample); });
  pending_count_ = 0;
  if (bad != samples.end())
    throw std::invalid_argument(fmt::format("AllanAccumulator: sample {} is {}; leave it out and call gap()",
                                            samples_ + static_cast<std::uint64_t>(bad - samples.begin()), *bad));
  samples_ += samples.size();
  if (!sums_->pyramid && samples_ > sums_->full_overlap_samples) sums_->become_pyramid();
  if (sums_->pyramid)
    sums_->pyramid->add(samples);
  else
    sums_->keep(samples);
}

void AllanAccumulator::gap() {
  flush();
  sums_->end_run();
}

AllanCurve AllanAccumulator::finish() {
  gap();
  const bool full = !sums_->pyramid;
  const std::vector<DifferenceSums> sums = full ? sums_->full_overlap() : sums_->pyramid->sums();
  samples_ = 0;
  sums_->kept = {};
  sums_->starts = {};
  sums_->pyramid.reset();
  return make_curve(interval_, sums_->factors, sums, full);
}

namespace {

double sum_over(std::span<const ProcessPtr> processes, double tau, std::optional<double> (Process::*variance)(double) const) {
  double sum = 0.0;
  for (const ProcessPtr& process : processes) sum += ((*process).*variance)(tau).value_or(0.0);
  return sum;
}

}  // namespace

double allan_variance(std::span<const ProcessPtr> processes, double tau) {
  return sum_over(processes, tau, &Process::allan_variance);
}

double hadamard_variance(std::span<const ProcessPtr> processes, double tau) {
  return sum_over(processes, tau, &Process::hadamard_variance);
}

}  // namespace coast::noise
