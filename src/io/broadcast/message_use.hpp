#pragma once
// What decoders of navigation messages have in common. Private to the room.

#include "coast/record/navigation.hpp"

namespace coast::io {

/// What became of a message.
enum class MessageUse {
  kPart,        ///< kept until its ephemeris is whole
  kEphemeris,   ///< completed an ephemeris, or repeats one
  kNotUsed,     ///< almanac and the like
  kWrong,       ///< parity, CRC or a number in it is wrong
  kImpossible,  ///< completed an orbit or a clock that cannot be
};

/// Tells a satellite's ephemeris from its next one.
struct EphemerisKey {
  geo::GpsTime toe, toc;
  int issue = -1;
  auto operator<=>(const EphemerisKey&) const = default;
};
[[nodiscard]] inline EphemerisKey key_of(const record::KeplerEphemeris& e) {
  return {e.toe, e.toc, e.issue};
}

/// Adds an ephemeris that is possible and not the one given last.
[[nodiscard]] MessageUse give(const record::KeplerEphemeris& ephemeris, EphemerisKey& given, record::NavigationRecording& into);

}  // namespace coast::io
