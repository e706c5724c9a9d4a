#pragma once
// Checksums of receivers' messages. Private to the room.

#include <cstdint>
#include <string_view>

namespace coast::io {

/// The 8-bit Fletcher checksum of UBX (RFC 1145 with sums modulo 256): the first sum in the low byte, the second in the high.
[[nodiscard]] std::uint16_t fletcher8(std::string_view bytes);
/// CRC-24Q of RTCM 3 and Galileo I/NAV: polynomial 0x1864CFB, begins with 0.
[[nodiscard]] std::uint32_t crc24q(std::string_view bytes);
/// CRC-16 of VectorNav: CCITT polynomial 0x1021, begins with 0; 0 over a message with its CRC, high byte first.
[[nodiscard]] std::uint16_t crc16_ccitt(std::string_view bytes);

/// CRC-32 of NovAtel: polynomial 0x04C11DB7 with the bits of each byte from the lowest on, begins with 0, not inverted at the
/// end.
[[nodiscard]] std::uint32_t crc32_novatel(std::string_view bytes);

}  // namespace coast::io
