#pragma once
// Biases between defects. Private to the room.

#include "coast/array/defects.hpp"
#include "parity_blocks.hpp"

namespace coast::array {

/// Least squares of block means = common signal of the block + bias of the sensor's run, over the runs in order, alternating
/// between both. A sensor's run ends where one of its channels becomes defective or recovers.
[[nodiscard]] std::vector<BiasRun> piecewise_biases(const ParityBlocks& blocks, const std::vector<Defect>& defects,
                                                    std::size_t samples);

}  // namespace coast::array
