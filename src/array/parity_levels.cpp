// The past of ChannelWindows: levels, and what the record shows of the tests.

#include <algorithm>
#include <cmath>

#include "parity_windows.hpp"

namespace coast::array {

namespace {

constexpr double kMedianOfOneDegree = 0.4549;  // of a chi-square
constexpr double kMedianOfThreeDegrees = 2.3660;

/// Blocks from one window that is learnt to the next: a quarter of its length.
std::size_t hop_of(std::size_t window) {
  return std::max<std::size_t>(1, window / 4);
}

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

double ChannelWindows::median_noise_ratio(std::size_t k, std::size_t blocks) const {
  return median_over_mean(dof(k) * static_cast<double>(blocks));
}

void ChannelWindows::learn(std::size_t b, const Set& set, const std::vector<std::size_t>& from) {
  for (std::size_t k = 0; k < sensors_; ++k) {
    for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
      const std::size_t blocks = kLevelWindows[i];
      if ((b + 1) % hop_of(blocks) != 0) continue;
      const LevelResidual level = level_residual(k, i, set, from);
      if (level.valid)
        level_learnt_[i][k].ratios.push_back(
            {mean_of(spread_of_means_, blocks), level.value * level.value / level.variance / kMedianOfOneDegree});
    }
    for (std::size_t i = 0; i < kNoiseWindows.size(); ++i) {
      const std::size_t blocks = kNoiseWindows[i];
      const double ratio = (b + 1) % hop_of(blocks) == 0 ? noise_ratio(k, blocks, from[k]) : -1.0;
      const double median = median_noise_ratio(k, blocks);
      if (ratio >= 0.0) noise_learnt_[i][k].ratios.push_back({mean_of(spread_of_samples_, blocks), ratio / median});
    }
    for (std::size_t i = 0; i < kMotionWindows.size(); ++i) {
      const std::size_t blocks = kMotionWindows[i];
      const double chi2 = (b + 1) % hop_of(blocks) == 0 ? motion_chi2(k, blocks, from[k]) : -1.0;
      if (chi2 >= 0.0) motion_learnt_[i][k].ratios.push_back({motion_of(blocks), chi2 / kMedianOfThreeDegrees});
    }
  }
}

/// Pieces of ten seconds, a sixtieth of a short record, a window at least.
TailFit ChannelWindows::tail_fit(std::size_t window) const {
  constexpr double kPiece = 10.0;
  constexpr double kPieces = 60.0;
  const double seconds = std::min(kPiece, blocks_.seconds * static_cast<double>(blocks_.count) / kPieces);
  TailFit fit;
  const std::size_t length = std::max(window, static_cast<std::size_t>(seconds / blocks_.seconds));
  fit.piece = length / hop_of(window);
  fit.chance = share_per_hour_ * static_cast<double>(length) * blocks_.seconds / 3600.0;
  return fit;
}

void ChannelWindows::fit_tests(std::vector<LearntTest>& sensors, std::size_t window, const std::vector<double>& thresholds,
                               const SquareOfRatio& square) const {
  std::vector<LargestRatios> largest;
  std::vector<Growth> growth(sensors_);
  std::vector<TailFit> fits(sensors_, tail_fit(window));
  for (std::size_t k = 0; k < sensors_; ++k) {
    fits[k].threshold = square(k, thresholds[k]);
    growth[k].inflation = fit_inflation(sensors[k].ratios);
    largest.push_back(largest_ratios(sensors[k].ratios, growth[k].inflation, fits[k].piece));
    for (std::vector<double>* ratios : {&largest.back().together, &largest.back().apart})
      for (double& ratio : *ratios) ratio = square(k, ratio);
    sensors[k].ratios = {};
  }
  fit_tails(largest, fits, growth);
  for (std::size_t k = 0; k < sensors_; ++k) {
    sensors[k].own = growth[k];
    sensors[k].usual = usual_growth(growth);
  }
}

void ChannelWindows::fit_learnt() {
  const SquareOfRatio as_it_is = [](std::size_t, double ratio) { return ratio; };
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i)
    fit_tests(level_learnt_[i], kLevelWindows[i], std::vector(sensors_, level_threshold_[i] / kMedianOfOneDegree), as_it_is);
  for (std::size_t i = 0; i < kNoiseWindows.size(); ++i) {
    const std::size_t blocks = kNoiseWindows[i];
    std::vector<double> thresholds;
    for (std::size_t k = 0; k < sensors_; ++k) thresholds.push_back(noise_threshold_[i][k] / median_noise_ratio(k, blocks));
    fit_tests(noise_learnt_[i], blocks, thresholds, [&](std::size_t k, double ratio) {
      const double score = NormalScore(dof(k) * static_cast<double>(blocks))(ratio * median_noise_ratio(k, blocks));
      return score > 0.0 ? score * score : 0.0;
    });
  }
  for (std::size_t i = 0; i < kMotionWindows.size(); ++i)
    fit_tests(motion_learnt_[i], kMotionWindows[i], std::vector(sensors_, motion_threshold_[i] / kMedianOfThreeDegrees),
              as_it_is);
  start_levels();
  std::fill(run_.begin(), run_.end(), 0);
  std::fill(valid_run_.begin(), valid_run_.end(), 0);
  entered_ = 0;
}

}  // namespace coast::array
