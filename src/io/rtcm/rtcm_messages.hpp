#pragma once
// RTCM 3 messages that are read, by number (RTCM 10403.3). Private to the room.

#include <cstdint>
#include <optional>

#include "../frames/frame_stream.hpp"
#include "coast/geo/time.hpp"
#include "coast/record/satellite.hpp"

namespace coast::io {

namespace rtcm {
inline constexpr std::uint32_t kGpsL1 = 1002, kGpsL1L2 = 1004, kGlonassL1 = 1010, kGlonassL1L2 = 1012;
inline constexpr std::uint32_t kPosition = 1005, kPositionAndHeight = 1006;
inline constexpr std::uint32_t kAntenna = 1007, kAntennaAndSerial = 1008, kReceiver = 1033;
inline constexpr std::uint32_t kSystemParameters = 1013;
inline constexpr std::uint32_t kGpsEphemeris = 1019, kGlonassEphemeris = 1020, kBeidouEphemeris = 1042, kQzssEphemeris = 1044,
                               kGalileoFnav = 1045, kGalileoInav = 1046;
}  // namespace rtcm

/// A multiple signal message: system, and 1 to 7.
struct MsmKind {
  record::SatelliteSystem system = record::SatelliteSystem::kGps;
  int number = 0;

  /// 1 to 3 leave out parts that a receiver needs to restore what was measured.
  [[nodiscard]] bool is_read() const { return number >= 4; }
  [[nodiscard]] bool has_rates() const { return number == 5 || number == 7; }
  [[nodiscard]] bool is_fine() const { return number >= 6; }
};
[[nodiscard]] std::optional<MsmKind> msm_kind(std::uint32_t id);
/// Observations of 1002, 1004, 1010 or 1012: GPS with SBAS, or GLONASS.
[[nodiscard]] std::optional<record::SatelliteSystem> legacy_system(std::uint32_t id);

/// The epoch of a message of observations.
/// @param near  GPS time to half a week; for 1009 to 1012, which state the time of day only, to half a day
/// @return      none for other messages, and for an impossible time
[[nodiscard]] std::optional<geo::GpsTime> rtcm_time(const MessageFrame& frame, geo::GpsTime near);
/// A message states no more than the time of day.
[[nodiscard]] bool is_of_day(const MessageFrame& frame);
/// What observations of GLONASS state: seconds of the day in Moscow, UTC + 3 h.
[[nodiscard]] std::optional<double> second_of_moscow_day(const MessageFrame& frame);
/// Reference station ID of a message of observations, or of a station.
[[nodiscard]] std::optional<int> rtcm_station_id(const MessageFrame& frame);

/// The week that a message states: an instant in it.
struct RtcmWeek {
  geo::GpsTime t;           ///< of the ephemeris or of the message
  bool certain = false;     ///< not modulo 1024
  bool of_message = false;  ///< the time of the message itself, not that of an ephemeris
};
/// @param near  decides between weeks modulo 1024; without it they are the latest before 2032
[[nodiscard]] std::optional<RtcmWeek> rtcm_week(const MessageFrame& frame, std::optional<geo::GpsTime> near);

/// Damage of the file, and the messages that no reader of RTCM uses, by name and number.
[[nodiscard]] record::Events rtcm_file_events(const FrameCensus& census, const std::string& file);

/// Messages of RTCM have been found whole in the first bytes of a file, and in more bytes than those of UBX.
[[nodiscard]] bool begins_as_rtcm3(std::string_view head);

}  // namespace coast::io
