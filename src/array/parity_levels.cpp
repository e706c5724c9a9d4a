// The past of ChannelWindows: levels, and inflation by motion.

#include <cmath>

#include "parity_windows.hpp"

namespace coast::array {

namespace {

constexpr double kMedianOfOneDegree = 0.4549;  // of a chi-square
constexpr double kMedianOfThreeDegrees = 2.3660;

}  // namespace

/// One step of each sensor's local-level filter, relative to the weighted mean of the set. The sum of all levels is not
/// observable and is kept constant.
void ChannelWindows::absorb(std::size_t b, const Set& set, const std::vector<std::size_t>& in_order_from) {
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
    for (std::size_t k = 0; k < sensors_; ++k) level_uncertainty_[i][k] += noise_.walk_variance(k);
    if (b < kLevelWindows[i]) continue;
    const std::size_t left = b - kLevelWindows[i];
    const auto takes_part = [&](std::size_t k) { return set[k] && in_order_from[k] <= left && has(k, left); };
    double weights = 0.0, common = 0.0;
    for (std::size_t k = 0; k < sensors_; ++k) {
      if (!takes_part(k)) continue;
      const double weight = 1.0 / noise_.block_variance(k, left);
      weights += weight;
      common += weight * (blocks_.means[k](channel_, at(left)) - level_[i][k]);
    }
    if (weights <= 0.0) continue;
    for (std::size_t k = 0; k < sensors_; ++k) {
      if (!takes_part(k)) continue;
      const double white = noise_.block_variance(k, left);
      const double gain = level_uncertainty_[i][k] / (level_uncertainty_[i][k] + white);
      level_[i][k] += gain * (blocks_.means[k](channel_, at(left)) - level_[i][k] - common / weights);
      level_uncertainty_[i][k] = gain * white;
    }
  }
}

void ChannelWindows::take_back(std::size_t k, std::size_t since, std::size_t b) {
  const auto count = static_cast<double>(b + 1 - since);
  const double level = level_[1][k] + (cross_[k](0, at(b + 1)) - cross_[k](0, at(since))) / count;
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
    level_[i][k] = level;
    level_uncertainty_[i][k] = variance_(at(k), at(b)) / count + noise_.walk_variance(k) * count / 3.0;
  }
}

double ChannelWindows::shift_of_level(std::size_t k, std::size_t since) const {
  const auto count = static_cast<double>(b_ + 1 - since);
  const double mean = (cross_[k](0, at(b_ + 1)) - cross_[k](0, at(since))) / count;
  return std::abs(mean) / std::sqrt(variance_(at(k), at(b_)) / count + level_uncertainty_[1][k]);
}

void ChannelWindows::follow(std::size_t k, std::size_t window, const Set& set, const std::vector<std::size_t>& from) {
  const LevelResidual residual = level_residual(k, window, set, from);
  if (!residual.valid) return;
  level_[window][k] += residual.value;
  level_uncertainty_[window][k] = residual.variance;
}

void ChannelWindows::move_to(std::size_t k, std::size_t window, const Set& set, const std::vector<std::size_t>& from) {
  const LevelResidual residual = level_residual(k, window, set, from);
  if (!residual.valid) return;
  const double level = level_[window][k] + residual.value;
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
    level_[i][k] = level;
    level_uncertainty_[i][k] = residual.variance;
  }
}

void ChannelWindows::learn(std::size_t b, const Set& set, const std::vector<std::size_t>& from) {
  for (std::size_t k = 0; k < sensors_; ++k) {
    for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
      const std::size_t blocks = kLevelWindows[i];
      if ((b + 1) % blocks != 0) continue;
      const LevelResidual level = level_residual(k, i, set, from);
      if (level.valid)
        level_ratios_[k][i].push_back({mean_power(blocks), level.value * level.value / level.variance / kMedianOfOneDegree});
    }
    for (std::size_t i = 0; i < kNoiseWindows.size(); ++i) {
      const std::size_t blocks = kNoiseWindows[i];
      const double ratio = (b + 1) % blocks == 0 ? noise_ratio(k, blocks, from[k]) : -1.0;
      const double median = std::pow(1.0 - 2.0 / (9.0 * dof(k) * static_cast<double>(blocks)), 3);
      if (ratio >= 0.0) noise_ratios_[k][i].push_back({mean_roughness(blocks), ratio / median});
    }
    for (std::size_t i = 0; i < kMotionWindows.size(); ++i) {
      const std::size_t blocks = kMotionWindows[i];
      const double chi2 = (b + 1) % blocks == 0 ? motion_chi2(k, blocks, from[k]) : -1.0;
      if (chi2 >= 0.0) motion_ratios_[k][i].push_back({mean_power(blocks), chi2 / kMedianOfThreeDegrees});
    }
  }
}

void ChannelWindows::fit_inflations() {
  for (std::size_t k = 0; k < sensors_; ++k) {
    for (std::size_t i = 0; i < kLevelWindows.size(); ++i) level_inflation_[k][i] = fit_inflation(level_ratios_[k][i]);
    for (std::size_t i = 0; i < kNoiseWindows.size(); ++i) noise_inflation_[k][i] = fit_inflation(noise_ratios_[k][i]);
    for (std::size_t i = 0; i < kMotionWindows.size(); ++i) motion_inflation_[k][i] = fit_inflation(motion_ratios_[k][i]);
  }
  level_ratios_.assign(sensors_, {});
  noise_ratios_.assign(sensors_, {});
  motion_ratios_.assign(sensors_, {});
  start_levels();
  std::fill(run_.begin(), run_.end(), 0);
  std::fill(valid_run_.begin(), valid_run_.end(), 0);
  entered_ = 0;
}

}  // namespace coast::array
