#pragma once
// The extended mechanisation: one strapdown integrates the weighted sum of all sensors, and every sensor keeps its own error
// states, which the sensors' differences tie to each other. Beyond Stebler et al. (2011), who merge first and know one error
// of the sum; where their errors are slow, sum and differences
// together hold all that the sensors say.

#include <span>
#include <string>

#include "coast/array/signals.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/imu.hpp"

namespace coast::array {

/// One sensor as its error model describes it.
struct ModelledSensor {
  std::string name;
  const noise::ImuErrorModel* model = nullptr;
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();  ///< its axes lie along the body's to `kMostTilt`
};
inline constexpr double kMemberBlock = 1.0;  ///< s
inline constexpr double kMostTilt = 0.2;     ///< rad: an error on one axis is held to act on one axis of the body

/// Weights of the sum in each channel by the inverse of the sensors' white noise: 6 x K, rows add up to 1. With these, and only
/// these, the noise of the sum is independent of all differences.
/// @throws std::invalid_argument  axes tilted by more than `kMostTilt`; a sensor without white noise on an axis
[[nodiscard]] Eigen::MatrixXd extended_weights(std::span<const ModelledSensor> sensors);

/// Error model of the sum: every process of every sensor as a share of it, in body axes.
/// @throws std::invalid_argument  as above
[[nodiscard]] noise::ImuErrorModel extended_error_model(const std::string& name, double rate_hz,
                                                        std::span<const ModelledSensor> sensors);

/// A channel that was merged from `levelled` signals with what was taken off put back, each sensor's with its weight: where all
/// may be used, the weighted sum of `signals`.
[[nodiscard]] Eigen::VectorXd with_offsets(const Signals& signals, const Signals& levelled, int channel,
                                           const Eigen::VectorXd& levelled_sum,
                                           const Eigen::Ref<const Eigen::VectorXd>& weights);

/// Means of every sensor over blocks of `kMemberBlock`, of one that may be used in all channels of the whole block. A filter
/// takes them for what the errors are in the middle.
/// @param block_s  short against the shortest correlation time of the sensors' processes
[[nodiscard]] record::MemberBlocks member_blocks(const Signals& signals, double block_s = kMemberBlock);

}  // namespace coast::array
