#pragma once
// LNAV, the navigation message on L1 C/A of GPS and QZSS: subframes to ephemerides (IS-GPS-200N, 20.3). Private to the room.

#include <array>
#include <map>
#include <span>

#include "message_use.hpp"

namespace coast::io {

/// Collects subframes of all satellites.
class LnavDecoder {
 public:
  /// @param words  ten words of 30 bits in the low bits, with the data bits as before the transmitter's inversion; the parity
  ///               bits as transmitted, or inverted like the data (as u-blox gives them)
  /// @param now    GPS time to some hours
  MessageUse take(record::Satellite satellite, std::span<const std::uint32_t> words, geo::GpsTime now,
                  record::NavigationRecording& into);
  /// @param data  the 24 data bits of each word, for receivers that have checked the parity and leave it out
  MessageUse take_data(record::Satellite satellite, const std::array<std::uint8_t, 30>& data, geo::GpsTime now,
                       record::NavigationRecording& into);

 private:
  struct Subframes {
    std::array<std::array<std::uint8_t, 30>, 3> data{};  ///< subframes 1 to 3 without parity
    std::array<bool, 3> known{};
    EphemerisKey given;
  };
  std::map<record::Satellite, Subframes> satellites_;
};

}  // namespace coast::io
