#pragma once
// Signals in blocks, the common signal of the array, and each sensor's constant imperfections. Private to the room.

#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

inline constexpr double kBlock = 0.1;  // s; but at least four samples

struct ParityBlocks {
  std::size_t length = 1;  ///< samples in a block
  std::size_t count = 0;   ///< whole blocks; the remaining samples of the record are not tested
  double seconds = 0.0;    ///< of a block

  /// [sensor] 6 x count: means. They include constant biases, but not constant responses to motion.
  std::vector<Eigen::MatrixXd> means;
  /// [sensor][block] bit c: all samples of channel c are available.
  std::vector<std::vector<std::uint8_t>> whole;
  /// 6 x count: median over the sensors, biases subtracted.
  Eigen::MatrixXd common;
  /// [sensor] median over the record of mean - common.
  std::vector<Channels> bias;
  /// 2 x count (rates, forces): power of the motion, slow and within blocks.
  Eigen::Matrix2Xd power;

  [[nodiscard]] bool has(std::size_t sensor, int channel, std::size_t block) const {
    return ((whole[sensor][block] >> channel) & 1U) != 0;
  }
};

/// @param present  [sensor][column] bit c: a value is available
[[nodiscard]] ParityBlocks make_blocks(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present);

/// Median; the values are reordered. 0 if there are none.
[[nodiscard]] double median_of(std::vector<double>& values);

}  // namespace coast::array
