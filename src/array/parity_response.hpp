#pragma once
// What differs constantly between the sensors: misalignment, scale, lag. Private to the room.

#include "parity_blocks.hpp"

namespace coast::array {

/// Regresses each sensor's residual on the motion (three axes and the channel's own rate of change) over the whole record and
/// subtracts the result from its samples: constant misalignment, scale and lag. Bisquare weights: a third of the record may be
/// of a defective sensor.
/// @param present  as for `make_blocks`
/// @param blocks  of the signals
[[nodiscard]] Signals without_constant_response(Signals signals, const std::vector<std::vector<std::uint8_t>>& present,
                                                const ParityBlocks& blocks);

}  // namespace coast::array
