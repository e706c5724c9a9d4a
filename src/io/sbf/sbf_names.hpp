#pragma once
// Names of SBF blocks. Private to the room.

#include <cstdint>
#include <string>

namespace coast::io {

/// "SBF MeasEpoch"; "SBF 4999" for a block without a name here.
[[nodiscard]] std::string sbf_block_name(std::uint32_t number);

}  // namespace coast::io
