#include "parity_thresholds.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "parity_blocks.hpp"

namespace coast::array {

namespace {

/// Probability of one evaluation, by the fixed point of u and its clumps.
double chance_per_evaluation(double per_hour, double step_s, std::size_t window, bool two_sided) {
  const double rate = per_hour * step_s / 3600.0;
  double chance = std::min(rate, 0.1);
  for (int round = 0; round < 20; ++round) {
    const double squared = noise::chi2_upper_quantile(1.0, two_sided ? chance : 2.0 * chance);
    chance = std::min(0.1, rate / std::min(1.0, squared / static_cast<double>(window)));
  }
  return chance;
}

}  // namespace

double normal_threshold(double per_hour, double step_s, std::size_t window, bool two_sided) {
  const double chance = chance_per_evaluation(per_hour, step_s, window, two_sided);
  return std::sqrt(noise::chi2_upper_quantile(1.0, two_sided ? chance : 2.0 * chance));
}

double chi2_threshold(double nu, double per_hour, double step_s, std::size_t window) {
  return noise::chi2_upper_quantile(nu, chance_per_evaluation(per_hour, step_s, window, false));
}

double for_uncertain_scale(double q, double epsilon) {
  return q * (1.0 + q * epsilon * epsilon);
}

double MotionInflation::at(double power) const {
  return std::max(1.0, constant + slope * power);
}

MotionInflation fit_inflation(std::vector<RatioAtPower> ratios) {
  constexpr std::size_t kLeast = 10;
  constexpr std::size_t kGroups = 6;
  if (ratios.size() < kLeast) return {};
  std::sort(ratios.begin(), ratios.end(), [](const RatioAtPower& a, const RatioAtPower& b) { return a.power < b.power; });
  const std::size_t groups = std::min(kGroups, ratios.size() / kLeast);
  std::vector<RatioAtPower> medians;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<double> power, ratio;
    for (std::size_t i = g * ratios.size() / groups; i < (g + 1) * ratios.size() / groups; ++i) {
      power.push_back(ratios[i].power);
      ratio.push_back(ratios[i].ratio);
    }
    medians.push_back({median_of(power), median_of(ratio)});
  }
  double mean_power = 0.0, mean_ratio = 0.0;
  for (const RatioAtPower& group : medians) {
    mean_power += group.power / static_cast<double>(groups);
    mean_ratio += group.ratio / static_cast<double>(groups);
  }
  double xx = 0.0, xy = 0.0, from_zero_xx = 0.0, from_zero_xy = 0.0;
  for (const RatioAtPower& group : medians) {
    xx += (group.power - mean_power) * (group.power - mean_power);
    xy += (group.power - mean_power) * (group.ratio - mean_ratio);
    from_zero_xx += group.power * group.power;
    from_zero_xy += group.power * group.ratio;
  }
  if (!(xx > 0.0) || xy <= 0.0) return {mean_ratio, 0.0};
  const double slope = xy / xx;
  if (mean_ratio < slope * mean_power) return {0.0, from_zero_xy / from_zero_xx};
  return {mean_ratio - slope * mean_power, slope};
}

}  // namespace coast::array
