#pragma once
// F/NAV, the navigation message on E5a-I of Galileo: pages to ephemerides (Galileo OS SIS ICD 2.1, 4.2). Private to the room.

#include <array>
#include <map>
#include <span>

#include "message_use.hpp"

namespace coast::io {

/// Collects pages of all satellites.
class FnavDecoder {
 public:
  /// @param page  244 bits from the first one after the synchronisation pattern on: 214 of data, 24 of CRC, 6 of tail
  /// @param now   GPS time to some hours
  MessageUse take(record::Satellite satellite, std::span<const std::uint8_t, 31> page, geo::GpsTime now,
                  record::NavigationRecording& into);

 private:
  using Page = std::array<std::uint8_t, 31>;
  struct Pages {
    std::array<Page, 4> data{};  ///< page types 1 to 4
    std::array<bool, 4> known{};
    EphemerisKey given;
  };
  std::map<record::Satellite, Pages> satellites_;
};

}  // namespace coast::io
