#pragma once
// D1 and D2, the navigation messages on B1I and B3I of BeiDou: subframes to ephemerides (BDS-SIS-ICD B1I 3.0, 5.2 and 5.3). MEO
// and IGSO satellites send D1, geostationary ones D2. Private to the room.

#include <array>
#include <map>
#include <span>

#include "message_use.hpp"

namespace coast::io {

/// Collects subframes of all satellites; all signals of one send the same.
class BeidouDecoder {
 public:
  /// @param words  ten words of 30 bits in the low bits, de-interleaved: 22 bits of data (26 in the first word) before the
  /// checks,
  ///               those of the first 11 bits before those of the others, or bit by bit in turn
  /// @param now    GPS time to some hours
  MessageUse take(record::Satellite satellite, std::span<const std::uint32_t> words, geo::GpsTime now,
                  record::NavigationRecording& into);

 private:
  using Data = std::array<std::uint8_t, 28>;  ///< without checks
  /// Subframes 1 to 3 of D1, or pages 1 to 10 of subframe 1 of D2, of one frame.
  struct Parts {
    std::array<Data, 10> data{};
    std::array<bool, 10> known{};
    int frame = -1;  ///< second of week at which the first of them begins
    EphemerisKey given;
  };
  MessageUse take_d1(record::Satellite satellite, const Data& data, geo::GpsTime now, record::NavigationRecording& into);
  MessageUse take_d2(record::Satellite satellite, const Data& data, geo::GpsTime now, record::NavigationRecording& into);
  [[nodiscard]] bool completes(Parts& parts, const Data& data, int part, int last, int frame) const;

  std::map<record::Satellite, Parts> satellites_;
};

}  // namespace coast::io
