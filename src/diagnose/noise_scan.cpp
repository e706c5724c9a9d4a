#include "noise_scan.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"

namespace coast::diagnose {

namespace {

constexpr double kRarest = -600.0;  // logarithm of a probability

/// Likelihood ratio for one degree of freedom that is as rare by chance as a sum of squares with the draws' mean and variance.
struct PowerByChance {
  double mean = 0.0;
  double variance = 0.0;
  explicit PowerByChance(const Eigen::ArrayXd& draws)
      : mean(draws.mean()), variance((draws - draws.mean()).square().sum() / static_cast<double>(draws.size() - 1)) {}
  [[nodiscard]] double likelihood_ratio(double power) const {
    const double dof = 2.0 * mean * mean / variance;
    const double log_p = noise::chi2_log_survival(dof, dof * power / mean);
    if (log_p > kRarest) return noise::chi2_upper_quantile(1.0, std::min(std::exp(log_p), 1.0 - 1e-12));
    // p = sqrt(2 / (pi r)) exp(-r / 2) of one degree of freedom, for r by the hundred.
    double ratio = -2.0 * log_p;
    for (int i = 0; i < 4; ++i) ratio = -2.0 * log_p + std::log(2.0 / geo::kPi) - std::log(ratio);
    return ratio;
  }
  /// One step of scoring: the score is (power - mean)/2, its variance the information.
  [[nodiscard]] double scored_variance(double power) const { return 2.0 * (power - mean) / variance; }
};

}  // namespace

std::vector<double> level_of(const NoiseEffect& effect, const std::vector<geo::GpsTime>& t, const MissionRun& run) {
  std::vector<double> level(t.size(), 1.0);
  if (!effect.level || t.empty()) return level;
  std::vector<double> count(t.size(), 0.0);
  std::ranges::fill(level, 0.0);
  run.for_each_sample([&](std::size_t, geo::GpsTime at, const Signals& signals) {
    const auto behind = std::ranges::upper_bound(t, at);
    const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, behind - t.begin() - 1));
    level[k] += effect.level(signals);
    count[k] += 1.0;
  });
  for (std::size_t k = 0; k < level.size(); ++k)
    if (count[k] > 0.0) level[k] /= count[k];
  return level;
}

NoiseSuspicions noise_suspicions(const Examination& examination, const MissionRun& run) {
  constexpr std::size_t kLeast = 20;  // intervals: below, nothing can be said of a variance
  const Disturbances& d = examination.disturbances;
  NoiseSuspicions result;
  if (d.t.size() < kLeast || d.score[0].rows() < 3) return result;
  std::vector<double> largest(static_cast<std::size_t>(d.score[0].rows() - 1), 0.0);
  for (const NoiseEffect& effect : noise_catalogue()) {
    const std::vector<double> level = level_of(effect, d.t, run);
    for (int axis = 0; axis < 3; ++axis)
      for (const double time : effect.times) {
        const std::size_t row = static_cast<std::size_t>(axis) + (effect.site == Site::kGyro ? 0U : 3U);
        const Eigen::ArrayXd power = effect.power(d, d.score[row], level, time).cast<double>();
        const PowerByChance chance(power.tail(power.size() - 1));
        if (!(chance.variance > 0.0) || !(chance.mean > 0.0)) continue;
        for (std::size_t i = 0; i < largest.size(); ++i)
          largest[i] = std::max(largest[i], chance.likelihood_ratio(power(static_cast<Eigen::Index>(i) + 1)));
        const double variance = chance.scored_variance(power(0));
        if (variance > 0.0)
          result.all.push_back(
              {{&effect, axis, std::sqrt(variance), time, d.t, level}, chance.likelihood_ratio(power(0)), 1.0});
      }
  }
  result.chance = LargestByChance::of(largest);
  for (NoiseSuspicion& s : result.all) s.p_value = result.chance.p_value(s.likelihood_ratio);
  return result;
}

// Uphill in steps of a factor, then the vertex of the parabola through the best three.
FittedEffect fitted_effect(const AddedNoise& from, const MissionInput& input, const estimate::StateLayout& layout,
                           double without) {
  constexpr int kMost = 8;
  constexpr double kStep = 1.0;  // of the root's logarithm
  const auto gain_at = [&](double log_root) {
    MissionInput with = input;
    AddedNoise noise = from;
    noise.root = std::exp(log_root);
    noise.add_to(with);
    if (with.setup.start)
      with.setup.start_sensor_errors = sensor_states_in(layout_of(with), layout, input.setup.start_sensor_errors);
    const std::optional<estimate::FilterResult> run = forward(std::move(with));
    return run ? run->log_likelihood - without : kBroken;
  };
  double x = std::log(from.root);
  double y = gain_at(x);
  double low = gain_at(x - kStep), high = gain_at(x + kStep);
  for (int i = 0; i < kMost && std::max(low, high) > y; ++i) {
    const bool up = high > low;
    x += up ? kStep : -kStep;
    double& ahead = up ? high : low;
    (up ? low : high) = y;
    y = ahead;
    ahead = gain_at(up ? x + kStep : x - kStep);
  }
  FittedEffect fitted{.noise = from, .log_sd = kStep, .gain = y};
  const double curvature = (2.0 * y - low - high) / (kStep * kStep);
  if (curvature > 0.0 && std::min(low, high) > kBroken) {
    fitted.log_sd = 1.0 / std::sqrt(curvature);
    const double vertex = x + 0.5 * (high - low) / (curvature * kStep);
    const double at_vertex = gain_at(vertex);
    if (at_vertex > y) {
      x = vertex;
      fitted.gain = at_vertex;
    }
  }
  fitted.noise.root = std::exp(x);
  return fitted;
}

Eigen::VectorXd sensor_states_in(const estimate::StateLayout& to, const estimate::StateLayout& from, const Eigen::VectorXd& x) {
  Eigen::VectorXd states = Eigen::VectorXd::Zero(to.sensor_end());
  if (x.size() < from.sensor_end()) return states;
  states.head(estimate::kNav) = x.head(estimate::kNav);
  auto next = from.sensors().begin();
  for (const estimate::StateLayout::SensorBlock& block : to.sensors()) {
    if (next == from.sensors().end() || next->process->name() != block.process->name() || next->size != block.size ||
        next->axis != block.axis || next->sensor != block.sensor)
      continue;
    states.segment(block.offset, block.size) = x.segment(next->offset, next->size);
    ++next;
  }
  return states;
}

estimate::StateLayout layout_of(const MissionInput& input) {
  return {input.setup.model, input.setup.C_s_b, input.setup.filter.auxiliary};
}

}  // namespace coast::diagnose
