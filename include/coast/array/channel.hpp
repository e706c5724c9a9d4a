#pragma once
// Noise of each sensor of an array, only from the differences between sensors: Stebler et al. (2011), Eqs. (6) and (11).

#include <Eigen/Core>
#include <span>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

/// Each sensor's own noise variance from the variances of the residuals to the mean of all K. The mean contains the sensor's
/// own noise and that of the others, so
///
///     var y_k = sigma_k^2 (1 - 2/K) + sum_j sigma_j^2 / K^2
///
/// and these K equations are solved. With K = 2 the two residuals are equal up to sign: only the sum is known and is divided
/// equally. The solution for a very quiet sensor may be negative; it is limited to at least `kLeastShare` of the mean.
/// @param residual_variances  K >= 2 values
/// @throws std::invalid_argument  fewer than two
[[nodiscard]] std::vector<double> own_variances(std::span<const double> residual_variances);
inline constexpr double kLeastShare = 0.02;

/// Subtracts, per channel, the offset of each sensor from the mean of all: means over `window_s`, linearly interpolated. The
/// remaining signals differ only by noise, so changing weights do not exchange one sensor's bias for another's: for slow errors
/// every merge is the plain mean.
/// @return the offsets subtracted in each window: [sensor](channel, window)
std::vector<Eigen::Matrix<double, kChannels, Eigen::Dynamic>> take_off_relative_offsets(Signals& signals, double window_s);

/// z_k - mean of the usable sensors, Eq. (11): K x N. Zero where a sensor is not usable, or is the only one.
[[nodiscard]] Eigen::MatrixXd residuals(const Signals& signals, int channel);

/// Noise of one channel over time.
struct NoiseOverTime {
  std::size_t block = 0;  ///< samples per column; the last one may have more
  /// K x blocks, each sensor's own, of one sample. Where a sensor is not usable: its size relative to the others, times their
  /// noise in the block.
  Eigen::MatrixXd variance;
};
/// Sample variances of the residuals in blocks of `window_s`, solved for the own variances of the sensors that are usable in at
/// least half of the block.
[[nodiscard]] NoiseOverTime noise_over_time(const Signals& signals, int channel, double window_s);

}  // namespace coast::array
