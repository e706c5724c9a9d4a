#pragma once
// Ephemerides of RTCM 3 (RTCM 10403.3, 3.5.9, 3.5.10 and 3.5.17 to 3.5.19). Private to the room.

#include <map>
#include <utility>

#include "../broadcast/message_use.hpp"
#include "../frames/frame.hpp"

namespace coast::io {

/// Reads 1019, 1020, 1042, 1044, 1045 and 1046; an ephemeris is repeated until its next issue, and kept once.
class RtcmEphemerides {
 public:
  /// @param now  GPS time to some hours
  /// @return     none for other messages
  std::optional<MessageUse> take(const MessageFrame& frame, geo::GpsTime now, record::NavigationRecording& into);

 private:
  MessageUse take_glonass(const MessageFrame& frame, geo::GpsTime now, record::NavigationRecording& into);

  std::map<std::pair<record::Satellite, int>, EphemerisKey> given_;  ///< by satellite and source: Galileo sends two
  std::map<record::Satellite, geo::GpsTime> given_glonass_;
};

/// Slot and frequency number in 1020.
[[nodiscard]] std::optional<std::pair<int, int>> channel_in_ephemeris(const MessageFrame& frame);

}  // namespace coast::io
