#pragma once
// I/NAV, the navigation message on E1-B and E5b-I of Galileo: pages to ephemerides (Galileo OS SIS ICD 2.1, 4.3). Private to
// the room.

#include <array>
#include <map>
#include <span>

#include "message_use.hpp"

namespace coast::io {

/// Table 89: signal-in-space accuracy by its index, m; 0 where the satellite gives none.
[[nodiscard]] double galileo_accuracy(int index);

/// Collects pages of all satellites; E1-B and E5b-I send the same words.
class InavDecoder {
 public:
  /// @param page  the even part in the first 16 bytes, from its first bit on, the odd part in the other 16
  /// @param now   GPS time to some hours
  MessageUse take(record::Satellite satellite, std::span<const std::uint8_t, 32> page, geo::GpsTime now,
                  record::NavigationRecording& into);

 private:
  using Word = std::array<std::uint8_t, 16>;  ///< 128 bits
  struct Words {
    std::array<Word, 5> data{};  ///< word types 1 to 5
    std::array<bool, 5> known{};
    EphemerisKey given;
  };
  std::map<record::Satellite, Words> satellites_;
};

}  // namespace coast::io
