#include "message_use.hpp"

#include "../ephemerides.hpp"

namespace coast::io {

MessageUse give(const record::KeplerEphemeris& ephemeris, EphemerisKey& given, record::NavigationRecording& into) {
  if (!is_possible(ephemeris)) return MessageUse::kImpossible;
  if (key_of(ephemeris) != given) into.kepler.push_back(ephemeris);
  given = key_of(ephemeris);
  return MessageUse::kEphemeris;
}

}  // namespace coast::io
