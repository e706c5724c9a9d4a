#pragma once
// Noise of each sensor, from the differences of the sensors. Private to the room.

#include <algorithm>
#include <vector>

#include "parity_blocks.hpp"

namespace coast::array {

/// Variances of K sensors from those of their residuals about the plain mean,
///     var r_k = sigma_k^2 (1 - 2/K) + sum_j sigma_j^2/K^2,
/// each at least a fiftieth of their mean. Two sensors get the same variance.
[[nodiscard]] Eigen::VectorXd own_variances(const Eigen::VectorXd& of_residuals);

/// Median of a mean square of nu degrees of freedom over its mean (Wilson & Hilferty 1931).
[[nodiscard]] double median_over_mean(double nu);

/// 1e-9 rad/s or m/s^2: sensors that differ by less are considered equal.
inline constexpr double kLeastVariance = 1e-18;

/// Noise of one channel in all sensors. A sensor with few values is given the noise of the noisiest; without two sensors to
/// compare, the noise is unbounded and no test can detect anything.
class ChannelNoise {
 public:
  /// @param memory_s  of the running medians, to either side
  ChannelNoise(const Signals& signals, const ParityBlocks& blocks, int channel, double memory_s);

  /// For a sample of sensor k about the mean of its block b.
  [[nodiscard]] double sample_variance(std::size_t k, std::size_t b) const;
  /// For a block's mean as used in windows: at low frequencies, so that correlation between samples is included.
  [[nodiscard]] double block_variance(std::size_t k, std::size_t b) const {
    return std::max(kLeastVariance, ratio_[k] * sample_variance(k, b));
  }
  /// Increment of the bias's random walk from block to block.
  [[nodiscard]] double walk_variance(std::size_t k) const { return walk_[k]; }
  /// Degrees of freedom of a block's mean square of samples about its mean.
  [[nodiscard]] double block_dof(std::size_t k) const { return dof_[k]; }
  /// Relative standard deviations of the standard deviations: for windows' means, for samples.
  [[nodiscard]] double level_uncertainty() const { return level_uncertainty_; }
  [[nodiscard]] double sample_uncertainty() const { return sample_uncertainty_; }

 private:
  void find_members();
  void mean_squares(const Signals& signals);
  void levels(double memory_s);
  void degrees_of_freedom();
  [[nodiscard]] Eigen::VectorXd for_all(const Eigen::VectorXd& of_members) const;
  [[nodiscard]] Eigen::VectorXd allan_of(std::size_t window, std::size_t& pairs) const;
  void slow_noise();
  [[nodiscard]] double residual_sample_variance(std::size_t k, std::size_t b) const;

  const ParityBlocks& blocks_;
  int channel_;
  std::size_t sensors_;
  std::vector<std::size_t> members_;  ///< sensors available for a quarter of the record: these are compared
  Eigen::MatrixXd squares_;           ///< member x block; negative unless every member has values
  std::size_t step_ = 1;              ///< blocks from node to node
  Eigen::MatrixXd level_;             ///< sensor x node
  std::vector<double> ratio_, walk_, dof_;
  double level_uncertainty_ = 0.0;
  double sample_uncertainty_ = 0.0;
};

}  // namespace coast::array
