#pragma once
// What is wrong with a sensor, once it is known that something is. Private to the room.

#include "coast/array/defects.hpp"
#include "parity_blocks.hpp"

namespace coast::array {

/// Fills kind and size: the likeliest of a constant, a factor, another axis and more noise in the samples of [from, to) (and of
/// a recovery after it where that is short) against the median of the other sensors. kUnknown where the residual keeps three
/// times the usual variance under each of them and is not white.
/// @param noise     variances of a sample, [sensor]
/// @param recovery  columns
void name_defect(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, const ParityBlocks& blocks,
                 const std::vector<Channels>& noise, std::size_t recovery, Defect& defect);

}  // namespace coast::array
