#pragma once
// The extended mechanisation: one strapdown integrates the weighted sum of all sensors, and every sensor keeps its own error
// states, which are coupled by measurements of the sensors' differences. An extension of Stebler et al. (2011), who merge first
// and model one error of the sum; for slow errors, sum and differences together contain all information of the sensors.

#include <span>
#include <string>

#include "coast/array/signals.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/imu.hpp"

namespace coast::array {

/// One sensor and its error model.
struct ModelledSensor {
  std::string name;
  const noise::ImuErrorModel* model = nullptr;
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();  ///< its axes are aligned with the body's to `kMostTilt`
};
inline constexpr double kMemberBlock = 1.0;  ///< s
inline constexpr double kMostTilt = 0.2;     ///< rad: an error on one axis is assumed to act on one axis of the body

/// Weights of the sum in each channel, inverse to the variances of the sensors' white noise: 6 x K, rows add up to 1. Only with
/// these weights is the noise of the sum independent of all differences.
/// @throws std::invalid_argument  axes tilted by more than `kMostTilt`; a sensor without white noise on an axis
[[nodiscard]] Eigen::MatrixXd extended_weights(std::span<const ModelledSensor> sensors);

/// Error model of the sum: every process of every sensor as a share of it, in body axes.
/// @throws std::invalid_argument  as above
[[nodiscard]] noise::ImuErrorModel extended_error_model(const std::string& name, double rate_hz,
                                                        std::span<const ModelledSensor> sensors);

/// A channel merged from `levelled` signals, with the subtracted offsets of each sensor added back with its weight: if all
/// sensors are usable, the weighted sum of `signals`.
[[nodiscard]] Eigen::VectorXd with_offsets(const Signals& signals, const Signals& levelled, int channel,
                                           const Eigen::VectorXd& levelled_sum,
                                           const Eigen::Ref<const Eigen::VectorXd>& weights);

/// Means of every sensor over blocks of `kMemberBlock`, if it is usable in all channels of the whole block. A filter uses them
/// as the errors at the middle of the block.
/// @param block_s  short compared with the shortest correlation time of the sensors' processes
[[nodiscard]] record::MemberBlocks member_blocks(const Signals& signals, double block_s = kMemberBlock);

}  // namespace coast::array
