#pragma once
// Classifies a detected defect of a sensor. Private to the room.

#include "coast/array/defects.hpp"
#include "parity_blocks.hpp"

namespace coast::array {

/// Sets kind and size: the likeliest of a constant, a factor, another axis and more noise in the samples of [from, to) (and, if
/// these are few, of a recovery after it) relative to the median of the other sensors. kUnknown if the residual's variance is
/// above three times the usual one under each of them and the residual is not white.
/// @param noise     variances of a sample, [sensor]
/// @param recovery  columns
void name_defect(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, const ParityBlocks& blocks,
                 const std::vector<Channels>& noise, std::size_t recovery, Defect& defect);

}  // namespace coast::array
