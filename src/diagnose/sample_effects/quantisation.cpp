#include <algorithm>
#include <cmath>

#include "sample_effects.hpp"

namespace coast::diagnose {

namespace {

/// The step of which all values are multiples; none if there is none.
std::optional<double> step_of(const Eigen::ArrayXd& values) {
  constexpr double kRounding = 1e-9;  // of the largest value: rounding of files and sums
  constexpr double kOnGrid = 0.02;    // of a step, rms; uniform would be 0.29
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const double least = kRounding * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  double step = 0.0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double gap = sorted[i] - sorted[i - 1];
    if (gap > least && (step == 0.0 || gap < step)) step = gap;
  }
  if (step == 0.0) return {};
  // A gap is a difference of two roundings: the grid's step is refined using the integer multiples.
  for (int round = 0; round < 2; ++round) {
    const Eigen::ArrayXd multiples = (values / step).round();
    const double square = multiples.square().sum();
    if (!(square > 0.0)) return {};
    step = (multiples * values).sum() / square;
  }
  const Eigen::ArrayXd rest = values / step - (values / step).round();
  return rest.square().mean() < kOnGrid * kOnGrid ? std::optional(step) : std::nullopt;
}

std::optional<double> find_step(const AxisSeries& series) {
  constexpr double kCoarse = 0.5;  // of the white noise of a sample: standard deviation of the rounding
  if (series.rounding_stated || series.values.size() < 100) return {};
  const std::optional<double> step = step_of(series.values);
  if (!step || *step / std::sqrt(12.0) < kCoarse * series.white_sd) return {};
  return step;
}

void add_rounding_noise(MissionInput& input, Site site, int axis, double step) {
  const record::ImuRecording& imu = input.imu;
  raise_noise(input, site, axis,
              {{imu.samples.front().t - imu.samples.front().dt, imu.samples.back().t, step * step / 12.0 / imu.rate_hz}});
}

}  // namespace

SampleEffect quantisation(Site site) {
  return {
      .name = "quantisation",
      .site = site,
      .parameter = "step",
      .unit = site == Site::kGyro ? "rad/s" : "m/s^2",
      .equation = "measured = q round(signal / q), white with variance q^2/12 a sample",
      .meaning = "The converter's steps are coarse beside the noise.",
      .separating_manoeuvre = "None is needed: the samples stand on the steps.",
      .source = "Widrow & Kollar (2008), section 4",
      .find = find_step,
      .model = add_rounding_noise,
      // While a smooth signal stays within a step, the error is as smooth as the signal.
      .residue = [](double step) { return step / std::sqrt(12.0); },
  };
}

}  // namespace coast::diagnose
