#pragma once
// Strings of the GLONASS navigation message: positions and clocks (GLONASS ICD 5.1, 4.3 to 4.7). Private to the room.

#include <array>
#include <map>
#include <span>

#include "message_use.hpp"

namespace coast::io {

/// Collects strings 1 to 4 of all satellites.
class GlonassDecoder {
 public:
  /// @param string  85 bits from the first (idle) bit on, time mark left out
  /// @param frame   tells frames apart: strings of one frame belong together
  /// @param channel frequency number, -7 to 6
  /// @param now     GPS time to some hours
  MessageUse take(record::Satellite satellite, std::span<const std::uint8_t> string, std::uint32_t frame, int channel,
                  geo::GpsTime now, record::NavigationRecording& into);

 private:
  using Bits = std::array<std::uint8_t, 11>;
  struct Strings {
    std::array<Bits, 4> data{};
    std::array<bool, 4> known{};
    std::uint32_t frame = 0;
    geo::GpsTime given;
  };
  std::map<record::Satellite, Strings> satellites_;
};

}  // namespace coast::io
