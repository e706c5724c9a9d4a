#pragma once
// How far the sensors of an array lie apart, block by block. Private to the room.

#include <array>

#include "parity_blocks.hpp"

namespace coast::array {

/// How far the sensors lie apart in the blocks of a record, 1 in a typical block: mean over three axes of the squared distance
/// of the sensors from their median, over its median in the record. The distance is the median over the sensors, so one that is
/// defective does not count. What all sensors show at once (vibration, impacts, places and clocks that are known to some
/// accuracy only) is no defect of one: residuals are judged by their growth with this spread.
struct SpreadSeries {
  Eigen::VectorXd now;    ///< of the block
  Eigen::VectorXd about;  ///< mean over a second about the block
};

struct SensorSpread {
  std::array<SpreadSeries, 2> of_means;    ///< of rates and of forces: means of blocks, about their own means over a minute
  std::array<SpreadSeries, 2> of_samples;  ///< samples about the means of their blocks
};

[[nodiscard]] SensorSpread sensor_spread(const Signals& signals, const ParityBlocks& blocks);

}  // namespace coast::array
