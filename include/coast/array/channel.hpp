#pragma once
// How noisy each sensor of an array is, from nothing but how the sensors differ: Stebler et al. (2011), Eqs. (6) and (11).

#include <Eigen/Core>
#include <span>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

/// Each sensor's own noise variance from the variances of the residuals against the mean of all K. The mean contains the
/// sensor's own noise and that of the others, so
///
///     var y_k = sigma_k^2 (1 - 2/K) + sum_j sigma_j^2 / K^2
///
/// and these K equations are solved. With K = 2 the two residuals are the same: the sum is known and is shared out equally.
/// A solution of a very quiet sensor may come out below zero; it is held at `kLeastShare` of the mean.
/// @param residual_variances  K >= 2 of them
/// @throws std::invalid_argument  fewer than two
[[nodiscard]] std::vector<double> own_variances(std::span<const double> residual_variances);
inline constexpr double kLeastShare = 0.02;

/// Takes off, channel by channel, by how much each sensor lies above or below the mean of all: means over `window_s`, and
/// straight lines between them. What is left differs by noise alone, so weights that change do not let one sensor's bias in
/// and another's out: for slow errors every merge is the plain mean.
/// @return the offsets taken off in each window: [sensor](channel, window)
std::vector<Eigen::Matrix<double, kChannels, Eigen::Dynamic>> take_off_relative_offsets(Signals& signals, double window_s);

/// z_k - mean of the sensors that may be used, Eq. (11): K x N. Zero where a sensor may not be used, or is alone.
[[nodiscard]] Eigen::MatrixXd residuals(const Signals& signals, int channel);

/// Noise of one channel over time.
struct NoiseOverTime {
  std::size_t block = 0;  ///< samples of a column, the last one may have more
  Eigen::MatrixXd
      variance;  ///< K x blocks, each sensor's own, of one sample; where a sensor may not be used: its mean elsewhere
};
/// Sample variances of the residuals in blocks of `window_s`, solved for each sensor's own among those that may be used
/// in at least half of the block.
[[nodiscard]] NoiseOverTime noise_over_time(const Signals& signals, int channel, double window_s);

}  // namespace coast::array
