#pragma once
// Kinds of records of MCAP (mcap.dev, "MCAP Format Specification"). Private to the room.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace coast::io {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
/// Kind and length of a record.
inline constexpr std::size_t kMcapRecordHead = 9;

enum class McapOp : std::uint8_t {
  kNone = 0,
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15,
};

}  // namespace coast::io
