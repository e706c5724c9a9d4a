#pragma once
// Signals in blocks, what the array has in common, and each sensor's constant imperfections. Private to the room.

#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

inline constexpr double kBlock = 0.1;  // s; but at least four samples

struct ParityBlocks {
  std::size_t length = 1;  ///< samples in a block
  std::size_t count = 0;   ///< whole blocks; what is left of the record after them is not tested
  double seconds = 0.0;    ///< of a block

  /// [sensor] 6 x count: means. Constant biases are in them, constant responses to motion are not.
  std::vector<Eigen::MatrixXd> means;
  /// [sensor][block] bit c: all samples of channel c are there.
  std::vector<std::vector<std::uint8_t>> whole;
  /// 6 x count: median over the sensors, biases taken off.
  Eigen::MatrixXd common;
  /// [sensor] median over the record of mean - common.
  std::vector<Channels> bias;
  /// 2 x count (rates, forces): power of the motion, slow and within blocks; what residuals of dynamics may grow with.
  Eigen::Matrix2Xd power;
  /// 2 x count: mean square of the common signal's sample-to-sample differences.
  Eigen::Matrix2Xd roughness;

  [[nodiscard]] bool has(std::size_t sensor, int channel, std::size_t block) const {
    return ((whole[sensor][block] >> channel) & 1U) != 0;
  }
};

/// @param present  [sensor][column] bit c: there is a value
[[nodiscard]] ParityBlocks make_blocks(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present);

/// Regresses each sensor's residual on the motion (three axes and the channel's own rate of change) over the whole record and
/// takes that off its means: constant misalignment, scale and lag. Bisquare weights: a third of the record may be defective.
void remove_constant_response(ParityBlocks& blocks);

/// Median; the values are reordered. 0 of none.
[[nodiscard]] double median_of(std::vector<double>& values);

}  // namespace coast::array
