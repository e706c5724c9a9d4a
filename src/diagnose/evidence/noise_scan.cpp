#include "evidence/noise_scan.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"

namespace coast::diagnose {

namespace {

constexpr double kRarest = -600.0;  // logarithm of a probability

/// Likelihood ratio for one degree of freedom as rare by chance as a sum of squares with the draws' mean and variance.
struct PowerByChance {
  double mean = 0.0;
  double variance = 0.0;
  explicit PowerByChance(const Eigen::ArrayXd& draws)
      : mean(draws.mean()), variance((draws - draws.mean()).square().sum() / static_cast<double>(draws.size() - 1)) {}
  [[nodiscard]] double likelihood_ratio(double power) const {
    const double dof = 2.0 * mean * mean / variance;
    const double log_p = noise::chi2_log_survival(dof, dof * power / mean);
    if (log_p > kRarest) return noise::chi2_upper_quantile(1.0, std::min(std::exp(log_p), 1.0 - 1e-12));
    // p = sqrt(2 / (pi r)) exp(-r / 2) of one degree of freedom, for large r.
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
  constexpr std::size_t kLeast = 20;  // intervals: fewer do not determine a variance
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

}  // namespace coast::diagnose
