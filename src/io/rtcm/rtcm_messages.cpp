#include "rtcm_messages.hpp"

#include <algorithm>
#include <array>

#include "../broadcast/bit_field.hpp"
#include "../ephemerides.hpp"
#include "coast/geo/leap_seconds.hpp"
#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr double kRtcmWeek = 604800.0, kRtcmDay = 86400.0;  // s
constexpr std::uint32_t kUnknownDay = 7;
constexpr std::size_t kEpochAt = 24;  // bit at which the time begins, after number and station

bool in(std::uint32_t id, std::uint32_t first, std::uint32_t last) {
  return id >= first && id <= last;
}

bool is_glonass_epoch(std::uint32_t id) {
  return in(id, 1081, 1087);
}

/// DF004, DF248, DF427: milliseconds of the week. DF416 and DF034: day of the week, 7 if not known, and milliseconds of the day
/// in Moscow, UTC + 3 h.
std::optional<geo::GpsTime> week_time_of(const BitField& bits, System system, geo::GpsTime near) {
  const double second = 1e-3 * bits.bits(kEpochAt, 30);
  if (second >= kRtcmWeek) return std::nullopt;
  const double ahead = system == System::kBeidou ? kGpsMinusBeidou : 0.0;
  return nearest_second_of_week(near - ahead, second) + ahead;
}

std::optional<geo::GpsTime> day_time_of(const BitField& bits, std::size_t at, geo::GpsTime near) {
  const double second = 1e-3 * bits.bits(at, 27);
  if (second > kRtcmDay) return std::nullopt;  // a leap second ends one second later
  return nearest_second_of_moscow_day(near, second);
}

std::optional<geo::GpsTime> glonass_time_of(const BitField& bits, geo::GpsTime near) {
  constexpr double kMoscow = 3.0 * geo::kHour;
  const std::uint32_t day = bits.bits(kEpochAt, 3);
  const auto of_day = day_time_of(bits, kEpochAt + 3, near);
  if (day == kUnknownDay || !of_day) return of_day;
  const double second = 1e-3 * bits.bits(kEpochAt + 3, 27);
  return nearest_second_of_week(near, kRtcmDay * day + second - kMoscow + geo::leap_seconds(near));
}

/// Week and time of ephemeris of a message: bits, unit and beginning of both.
struct WeekField {
  std::uint32_t id;
  std::size_t week_at, week_bits;
  int first, weeks;
  std::size_t toe_at, toe_bits;
  double unit, behind;  ///< s
};
constexpr std::array<WeekField, 5> kWeekFields = {
    {{rtcm::kGpsEphemeris, 18, 10, 0, 1024, 288, 16, 16.0, 0.0},
     {rtcm::kQzssEphemeris, 446, 10, 0, 1024, 246, 16, 16.0, 0.0},
     {rtcm::kBeidouEphemeris, 18, 13, kBeidouFirstWeek, kBeidouWeeks, 299, 17, 8.0, kGpsMinusBeidou},
     {rtcm::kGalileoFnav, 18, 12, kGalileoFirstWeek, kGalileoWeeks, 294, 14, 60.0, 0.0},
     {rtcm::kGalileoInav, 18, 12, kGalileoFirstWeek, kGalileoWeeks, 294, 14, 60.0, 0.0}}};

/// Of the weeks that are the same modulo 1024: the nearest one, or the latest before 2032.
int whole_week(int stated, std::optional<geo::GpsTime> near) {
  constexpr int kWeeks = 1024, kAhead = 260;  // some years of recordings made after this program
  const int last = near ? near->week() + kWeeks / 2 : geo::built_in_leap_seconds().expiry.week() + kAhead;
  return last - ((last - stated) % kWeeks + kWeeks) % kWeeks;
}

/// 1013: modified Julian day, second of the day in UTC, leap seconds.
std::optional<RtcmWeek> day_of_system_parameters(const BitField& bits, std::size_t bytes) {
  constexpr int kFirstDay = 44244;  // 1980-01-06
  constexpr int kLastDay = 80000;
  constexpr std::size_t kBytes = 9;
  if (bytes < kBytes) return std::nullopt;
  const auto day = static_cast<int>(bits.bits(24, 16));
  const std::uint32_t second = bits.bits(40, 17), leap = bits.bits(62, 8);
  if (day < kFirstDay || day > kLastDay || second > kRtcmDay) return std::nullopt;
  return RtcmWeek{geo::GpsTime() + kRtcmDay * (day - kFirstDay) + second + leap, true, true};
}

bool is_read_rtcm(std::uint32_t id) {
  constexpr std::array kRead = {rtcm::kGpsL1,           rtcm::kGpsL1L2,           rtcm::kGlonassL1,    rtcm::kGlonassL1L2,
                                rtcm::kPosition,        rtcm::kPositionAndHeight, rtcm::kAntenna,      rtcm::kAntennaAndSerial,
                                rtcm::kReceiver,        rtcm::kSystemParameters,  rtcm::kGpsEphemeris, rtcm::kGlonassEphemeris,
                                rtcm::kBeidouEphemeris, rtcm::kQzssEphemeris,     rtcm::kGalileoFnav,  rtcm::kGalileoInav};
  const auto msm = msm_kind(id);
  return msm ? msm->is_read() : std::ranges::find(kRead, id) != kRead.end();
}

}  // namespace

std::optional<MsmKind> msm_kind(std::uint32_t id) {
  constexpr std::array kSystems = {System::kGps,  System::kGlonass, System::kGalileo, System::kSbas,
                                   System::kQzss, System::kBeidou,  System::kNavic};
  constexpr std::uint32_t kFirst = 1070, kStep = 10, kKinds = 7;
  if (id < kFirst || id >= kFirst + kStep * kSystems.size()) return std::nullopt;
  const std::uint32_t number = (id - kFirst) % kStep;
  if (number < 1 || number > kKinds) return std::nullopt;
  return MsmKind{kSystems.at((id - kFirst) / kStep), static_cast<int>(number)};
}

std::optional<System> legacy_system(std::uint32_t id) {
  if (id == rtcm::kGpsL1 || id == rtcm::kGpsL1L2) return System::kGps;
  if (id == rtcm::kGlonassL1 || id == rtcm::kGlonassL1L2) return System::kGlonass;
  return std::nullopt;
}

bool is_of_day(const MessageFrame& frame) {
  if (frame.protocol != Protocol::kRtcm3) return false;
  return in(frame.id, 1009, 1012) || (is_glonass_epoch(frame.id) && bits_of(frame.payload).bits(kEpochAt, 3) == kUnknownDay);
}

std::optional<geo::GpsTime> rtcm_time(const MessageFrame& frame, geo::GpsTime near) {
  constexpr std::size_t kBytes = 7;  // number, station, time
  if (frame.protocol != Protocol::kRtcm3 || frame.payload.size() < kBytes) return std::nullopt;
  const BitField bits = bits_of(frame.payload);
  if (is_glonass_epoch(frame.id)) return glonass_time_of(bits, near);
  if (in(frame.id, 1009, 1012)) return day_time_of(bits, kEpochAt, near);
  if (const auto msm = msm_kind(frame.id)) return week_time_of(bits, msm->system, near);
  return in(frame.id, 1001, 1004) ? week_time_of(bits, System::kGps, near) : std::nullopt;
}

std::optional<double> second_of_moscow_day(const MessageFrame& frame) {
  const bool of_day = in(frame.id, 1009, 1012);
  if (frame.protocol != Protocol::kRtcm3 || (!of_day && !is_glonass_epoch(frame.id))) return std::nullopt;
  return 1e-3 * bits_of(frame.payload).bits(of_day ? kEpochAt : kEpochAt + 3, 27);
}

std::optional<int> rtcm_station_id(const MessageFrame& frame) {
  constexpr std::size_t kBytes = 3;
  const bool stated = in(frame.id, 1001, 1013) || frame.id == rtcm::kReceiver || msm_kind(frame.id).has_value();
  if (frame.protocol != Protocol::kRtcm3 || !stated || frame.payload.size() < kBytes) return std::nullopt;
  return static_cast<int>(bits_of(frame.payload).bits(12, 12));
}

std::optional<RtcmWeek> rtcm_week(const MessageFrame& frame, std::optional<geo::GpsTime> near) {
  constexpr std::size_t kBytes = 60;  // no ephemeris is shorter
  if (frame.protocol != Protocol::kRtcm3) return std::nullopt;
  const BitField bits = bits_of(frame.payload);
  if (frame.id == rtcm::kSystemParameters) return day_of_system_parameters(bits, frame.payload.size());
  for (const WeekField& field : kWeekFields) {
    if (field.id != frame.id || frame.payload.size() < kBytes) continue;
    const auto stated = static_cast<int>(bits.bits(field.week_at, field.week_bits));
    const double toe = field.unit * bits.bits(field.toe_at, field.toe_bits);
    if (toe >= kRtcmWeek) return std::nullopt;
    const bool certain = field.weeks > 1024;
    const int week = certain ? field.first + stated : whole_week(stated, near);
    return RtcmWeek{geo::GpsTime::from_week(week, toe + field.behind), certain, false};
  }
  return std::nullopt;
}

record::Events rtcm_file_events(const FrameCensus& census, const std::string& file) {
  return file_events(census, file,
                     [](Protocol protocol, std::uint32_t id) { return protocol == Protocol::kRtcm3 && is_read_rtcm(id); });
}

bool begins_as_rtcm3(std::string_view head) {
  std::size_t rtcm_bytes = 0, ubx_bytes = 0;
  for (std::size_t at = 0; at < head.size();) {
    const std::string_view ahead = head.substr(at);
    FrameTrial trial;
    if (head[at] == '\xd3') trial = try_rtcm3(ahead);
    const bool rtcm = trial.verdict == FrameTrial::Verdict::kFrame;
    if (head[at] == '\xb5') trial = try_ubx(ahead);
    const bool whole = trial.verdict == FrameTrial::Verdict::kFrame;
    if (whole) (rtcm ? rtcm_bytes : ubx_bytes) += trial.size;
    at += whole ? trial.size : 1;
  }
  return rtcm_bytes > ubx_bytes;
}

}  // namespace coast::io
