// Ephemerides of NovAtel's logs (OEM7 Commands and Logs Reference Manual): subframes of GPS and QZSS as received, and the
// decoded ephemerides of all systems. Angles of the latter are in radians.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "../broadcast/galileo_inav.hpp"
#include "../broadcast/gps_lnav.hpp"
#include "../counted.hpp"
#include "../ephemerides.hpp"
#include "../rinex_lines.hpp"
#include "coast/record/error.hpp"
#include "novatel_log.hpp"
#include "novatel_readers.hpp"
#include "novatel_signals.hpp"

namespace coast::io {

namespace {

using record::KeplerEphemeris;
using System = record::SatelliteSystem;
using Subframe = std::array<std::uint8_t, 30>;

constexpr std::array<NovAtelWord, 2> kFlags = {{{"FALSE", 0}, {"TRUE", 1}}};

/// A second of week near an instant; none for what is no second of week.
std::optional<geo::GpsTime> second_near(geo::GpsTime now, double second) {
  constexpr double kWeekSeconds = 604800.0;
  if (!(second >= 0.0 && second <= kWeekSeconds)) return std::nullopt;
  return nearest_second_of_week(now, second);
}

bool has_only_numbers(const KeplerEphemeris& e) {
  const double sum = e.clock[0] + e.clock[1] + e.clock[2] + e.sqrt_a + e.eccentricity + e.mean_anomaly + e.delta_n + e.perigee +
                     e.node + e.node_rate + e.inclination + e.inclination_rate + e.cuc + e.cus + e.crc + e.crs + e.cic + e.cis +
                     e.accuracy_m + e.group_delay[0] + e.group_delay[1];
  return std::isfinite(sum);
}

/// The corrections in the order of all logs.
void read_corrections(NovAtelFields& f, KeplerEphemeris& e) {
  e.cuc = f.f64();
  e.cus = f.f64();
  e.crc = f.f64();
  e.crs = f.f64();
  e.cic = f.f64();
  e.cis = f.f64();
}

void read_clock(NovAtelFields& f, KeplerEphemeris& e) {
  for (double& c : e.clock) c = f.f64();
}

class NovAtelNavigationReader {
 public:
  explicit NovAtelNavigationReader(const std::filesystem::path& file) : stream_(file) {}

  record::NavigationRecording read() {
    recording_.source = stream_.name();
    NovAtelLog log;
    while (stream_.next(log)) take(log);
    static_cast<void>(sort_out(recording_));  // RAWEPHEM and GPSEPHEM say the same
    if (recording_.kepler.empty() && recording_.tabulated.empty()) refuse();
    report();
    return std::move(recording_);
  }

 private:
  void take(const NovAtelLog& log);
  [[nodiscard]] MessageUse decode(const NovAtelLog& log, geo::GpsTime now);
  [[nodiscard]] MessageUse raw_ephemeris(NovAtelFields f, geo::GpsTime now);
  [[nodiscard]] MessageUse raw_subframe(NovAtelFields f, System system, geo::GpsTime now);
  [[nodiscard]] MessageUse subframe(record::Satellite satellite, NovAtelFields& f, geo::GpsTime now);
  [[nodiscard]] MessageUse gps_ephemeris(NovAtelFields f, System system, geo::GpsTime now);
  [[nodiscard]] MessageUse beidou_ephemeris(NovAtelFields f, geo::GpsTime now);
  [[nodiscard]] MessageUse glonass_ephemeris(NovAtelFields f);
  [[nodiscard]] MessageUse galileo_both(NovAtelFields f, geo::GpsTime now);
  [[nodiscard]] MessageUse galileo_inav(NovAtelFields f, geo::GpsTime now);
  [[nodiscard]] MessageUse galileo_fnav(NovAtelFields f, geo::GpsTime now);
  [[nodiscard]] MessageUse ionosphere(NovAtelFields f);
  [[nodiscard]] MessageUse keep(std::optional<record::Satellite> satellite, std::optional<geo::GpsTime> toe,
                                std::optional<geo::GpsTime> toc, KeplerEphemeris e);
  [[noreturn]] void refuse() const;
  void report();

  // I/NAV of E1-B and E5b-I with the clock of E5b and E1; F/NAV of E5a-I with the clock of E5a and E1 (RINEX 3.05, table A8).
  static constexpr int kInavSources = 1 | 1 << 2 | 1 << 9, kFnavSources = 1 << 1 | 1 << 8;

  NovAtelStream stream_;
  record::NavigationRecording recording_;
  LnavDecoder lnav_;
  std::map<std::pair<record::Satellite, int>, EphemerisKey> given_;  ///< by satellite and sources
  long spoiled_ = 0, impossible_ = 0, no_week_ = 0, unknown_ = 0;
};

void NovAtelNavigationReader::take(const NovAtelLog& log) {
  // A coarse time does: the logs need the week only.
  const auto now = novatel_time(static_cast<std::uint32_t>(log.week), log.seconds);
  switch (now ? decode(log, *now) : MessageUse::kNotUsed) {
    case MessageUse::kWrong:
      ++spoiled_;
      break;
    case MessageUse::kImpossible:
      ++impossible_;
      break;
    case MessageUse::kNotUsed:
      if (!now && log.id == novatel::kRawEphem) ++no_week_;
      break;
    case MessageUse::kPart:
    case MessageUse::kEphemeris:
      break;
  }
}

MessageUse NovAtelNavigationReader::decode(const NovAtelLog& log, geo::GpsTime now) {
  switch (log.id) {
    case novatel::kRawEphem:
      return raw_ephemeris(log.fields(), now);
    case novatel::kRawGpsSubframe:
      return raw_subframe(log.fields(), System::kGps, now);
    case novatel::kQzssRawSubframe:
      return raw_subframe(log.fields(), System::kQzss, now);
    case novatel::kGpsEphem:
      return gps_ephemeris(log.fields(), System::kGps, now);
    case novatel::kQzssEphemeris:
      return gps_ephemeris(log.fields(), System::kQzss, now);
    case novatel::kBdsEphemeris:
      return beidou_ephemeris(log.fields(), now);
    case novatel::kGloEphemeris:
      return glonass_ephemeris(log.fields());
    case novatel::kGalEphemeris:
      return galileo_both(log.fields(), now);
    case novatel::kGalInavEphemeris:
      return galileo_inav(log.fields(), now);
    case novatel::kGalFnavEphemeris:
      return galileo_fnav(log.fields(), now);
    case novatel::kIonUtc:
      return ionosphere(log.fields());
    default:
      return MessageUse::kNotUsed;
  }
}

MessageUse NovAtelNavigationReader::keep(std::optional<record::Satellite> satellite, std::optional<geo::GpsTime> toe,
                                         std::optional<geo::GpsTime> toc, KeplerEphemeris e) {
  if (!satellite) {
    ++unknown_;
    return MessageUse::kNotUsed;
  }
  if (!toe || !toc || !has_only_numbers(e)) return MessageUse::kImpossible;
  e.satellite = *satellite;
  e.toe = *toe;
  e.toc = *toc;
  return give(e, given_[{*satellite, e.sources}], recording_);
}

/// PRN, week and second of reference, subframes 1 to 3 without their parity.
MessageUse NovAtelNavigationReader::raw_ephemeris(NovAtelFields f, geo::GpsTime now) {
  const auto satellite = novatel_satellite(System::kGps, f.u32());
  static_cast<void>(f.u32());
  static_cast<void>(f.u32());
  if (!f.good()) return MessageUse::kWrong;
  if (!satellite) return ++unknown_, MessageUse::kNotUsed;
  MessageUse use = MessageUse::kPart;
  for (int i = 0; i < 3 && use == MessageUse::kPart; ++i) use = subframe(*satellite, f, now);
  return use;
}

/// Decoder, PRN, number of the subframe, subframe; QZSS has no decoder.
MessageUse NovAtelNavigationReader::raw_subframe(NovAtelFields f, System system, geo::GpsTime now) {
  if (system == System::kGps) static_cast<void>(f.u32());
  const auto satellite = novatel_satellite(system, f.u32());
  static_cast<void>(f.u32());
  if (!f.good()) return MessageUse::kWrong;
  if (!satellite) return ++unknown_, MessageUse::kNotUsed;
  return subframe(*satellite, f, now);
}

MessageUse NovAtelNavigationReader::subframe(record::Satellite satellite, NovAtelFields& f, geo::GpsTime now) {
  Subframe data{};
  const std::string_view bytes = f.bytes(data.size());
  if (!f.good()) return MessageUse::kWrong;
  std::ranges::transform(bytes, data.begin(), [](char c) { return static_cast<std::uint8_t>(c); });
  return lnav_.take_data(satellite, data, now, recording_);
}

/// GPSEPHEM, and QZSSEPHEMERIS, which begins alike.
MessageUse NovAtelNavigationReader::gps_ephemeris(NovAtelFields f, System system, geo::GpsTime now) {
  KeplerEphemeris e;
  const std::uint32_t prn = f.u32();
  static_cast<void>(f.f64());  // time of the subframe
  e.health = static_cast<int>(f.u32() & 0x3fU);
  e.issue = static_cast<int>(f.u32() & 0xffU);
  const auto issue3 = static_cast<int>(f.u32() & 0xffU);
  static_cast<void>(f.u32());
  static_cast<void>(f.u32());  // week, with and without roll-over
  const auto toe = second_near(now, f.f64());
  e.sqrt_a = std::sqrt(f.f64());
  e.delta_n = f.f64();
  e.mean_anomaly = f.f64();
  e.eccentricity = f.f64();
  e.perigee = f.f64();
  read_corrections(f, e);
  e.inclination = f.f64();
  e.inclination_rate = f.f64();
  e.node = f.f64();
  e.node_rate = f.f64();
  static_cast<void>(f.u32());  // IODC
  const auto toc = second_near(now, f.f64());
  e.group_delay[0] = f.f64();
  read_clock(f, e);
  static_cast<void>(f.word(kFlags));  // anti-spoofing
  static_cast<void>(f.f64());         // corrected mean motion
  e.accuracy_m = std::sqrt(f.f64());  // a variance
  if (!f.good()) return MessageUse::kWrong;
  if (e.issue != issue3) return MessageUse::kPart;
  return keep(novatel_satellite(system, prn), toe, toc, e);
}

MessageUse NovAtelNavigationReader::beidou_ephemeris(NovAtelFields f, geo::GpsTime now) {
  KeplerEphemeris e;
  const std::uint32_t prn = f.u32();
  static_cast<void>(f.u32());  // week of BeiDou time
  e.accuracy_m = f.f64();
  e.health = static_cast<int>(f.u32() & 1U);
  e.group_delay[0] = f.f64();
  e.group_delay[1] = f.f64();
  static_cast<void>(f.u32());  // age of the clock
  const double toc = f.u32();
  read_clock(f, e);
  e.issue = static_cast<int>(f.u32() & 0xffU);
  const double toe = f.u32();
  e.sqrt_a = f.f64();
  e.eccentricity = f.f64();
  e.perigee = f.f64();
  e.delta_n = f.f64();
  e.mean_anomaly = f.f64();
  e.node = f.f64();
  e.node_rate = f.f64();
  e.inclination = f.f64();
  e.inclination_rate = f.f64();
  read_corrections(f, e);
  if (!f.good()) return MessageUse::kWrong;
  const auto in_gps = [&](double second) -> std::optional<geo::GpsTime> {
    const auto t = second_near(now - kGpsMinusBeidou, second);
    return t ? std::optional(*t + kGpsMinusBeidou) : std::nullopt;
  };
  return keep(novatel_satellite(System::kBeidou, prn), in_gps(toe), in_gps(toc), e);
}

/// The time of the ephemeris is in GPS time, milliseconds of the week.
MessageUse NovAtelNavigationReader::glonass_ephemeris(NovAtelFields f) {
  constexpr double kMillisecond = 1e-3;
  constexpr int kFirstChannel = -7, kFirstBad = 4;
  const auto satellite = novatel_satellite(System::kGlonass, f.u16());
  record::TabulatedEphemeris e;
  e.channel = f.u16() + kFirstChannel;
  f.skip_text(1);  // kind of satellite
  f.skip_text(1);
  const std::uint32_t week = f.u16();
  const double second = std::round(kMillisecond * f.u32());
  static_cast<void>(f.u32());  // from GLONASS to GPS time
  static_cast<void>(f.u16());  // day
  f.skip_text(1);
  f.skip_text(1);
  static_cast<void>(f.u32());  // issue
  e.health = f.u32() >= kFirstBad ? 1 : 0;
  e.r_e = f.vector();
  e.v_e = f.vector();
  e.a_e = f.vector();
  e.clock_bias = -f.f64();
  static_cast<void>(f.f64());  // difference between the frequencies
  e.clock_drift = f.f64();
  if (!f.good()) return MessageUse::kWrong;
  if (!satellite) return ++unknown_, MessageUse::kNotUsed;
  const auto t = novatel_time(week, second);
  if (!t || !is_possible(e) || !std::isfinite(e.clock_drift)) return MessageUse::kImpossible;
  e.satellite = *satellite;
  e.t = *t;
  recording_.tabulated.push_back(e);
  return MessageUse::kEphemeris;
}

/// GALEPHEMERIS of OEM6: the orbit, and the clocks of both messages.
MessageUse NovAtelNavigationReader::galileo_both(NovAtelFields f, geo::GpsTime now) {
  KeplerEphemeris e;
  const auto satellite = novatel_satellite(System::kGalileo, f.u32());
  const bool has_fnav = (f.word(kFlags) & 1U) != 0, has_inav = (f.word(kFlags) & 1U) != 0;
  const int health_e1 = f.u8() & 3, health_e5a = f.u8() & 3, health_e5b = f.u8() & 3;
  const int valid_e1 = f.u8() & 1, valid_e5a = f.u8() & 1, valid_e5b = f.u8() & 1;
  e.accuracy_m = accuracy_of_sisa(f.u8());
  static_cast<void>(f.u8());
  e.issue = static_cast<int>(f.u32() & 0x3ffU);
  const auto toe = second_near(now, f.u32());
  e.sqrt_a = f.f64();
  e.delta_n = f.f64();
  e.mean_anomaly = f.f64();
  e.eccentricity = f.f64();
  e.perigee = f.f64();
  read_corrections(f, e);
  e.inclination = f.f64();
  e.inclination_rate = f.f64();
  e.node = f.f64();
  e.node_rate = f.f64();
  KeplerEphemeris inav = e, fnav = e;
  const auto toc_fnav = second_near(now, f.u32());
  read_clock(f, fnav);
  const auto toc_inav = second_near(now, f.u32());
  read_clock(f, inav);
  const double delay_e5a = f.f64(), delay_e5b = f.f64();
  if (!f.good()) return MessageUse::kWrong;
  // Health in the bits of RINEX 3.05, table A8.
  inav.health = fnav.health = valid_e1 | health_e1 << 1 | valid_e5a << 3 | health_e5a << 4 | valid_e5b << 6 | health_e5b << 7;
  inav.sources = kInavSources;
  fnav.sources = kFnavSources;
  inav.group_delay = {delay_e5a, delay_e5b};
  fnav.group_delay = {delay_e5a, 0.0};
  MessageUse use = MessageUse::kNotUsed;
  if (has_inav) use = keep(satellite, toe, toc_inav, inav);
  return has_fnav ? keep(satellite, toe, toc_fnav, fnav) : use;
}

/// Times, orbit and clock of GALINAVEPHEMERIS and GALFNAVEPHEMERIS.
struct GalileoTimes {
  std::optional<geo::GpsTime> toe, toc;
};

GalileoTimes read_galileo(NovAtelFields& f, geo::GpsTime now, KeplerEphemeris& e) {
  e.issue = f.u16() & 0x3ff;
  e.accuracy_m = accuracy_of_sisa(f.u8());
  static_cast<void>(f.u8());  // source, or reserved
  GalileoTimes times;
  times.toe = second_near(now, f.u32());
  times.toc = second_near(now, f.u32());
  e.mean_anomaly = f.f64();
  e.delta_n = f.f64();
  e.eccentricity = f.f64();
  e.sqrt_a = f.f64();
  e.inclination = f.f64();
  e.inclination_rate = f.f64();
  e.node = f.f64();
  e.perigee = f.f64();
  e.node_rate = f.f64();
  read_corrections(f, e);
  read_clock(f, e);
  e.group_delay[0] = f.f64();
  return times;
}

MessageUse NovAtelNavigationReader::galileo_inav(NovAtelFields f, geo::GpsTime now) {
  KeplerEphemeris e;
  e.sources = kInavSources;
  const auto satellite = novatel_satellite(System::kGalileo, f.u32());
  const int health_e5b = f.u8() & 3, valid_e5b = f.u8() & 1;
  for (int i = 0; i < 2; ++i) static_cast<void>(f.u8());
  const int health_e1 = f.u8() & 3, valid_e1 = f.u8() & 1;
  for (int i = 0; i < 2; ++i) static_cast<void>(f.u8());
  e.health = valid_e1 | health_e1 << 1 | valid_e5b << 6 | health_e5b << 7;
  const GalileoTimes times = read_galileo(f, now, e);
  e.group_delay[1] = f.f64();
  if (!f.good()) return MessageUse::kWrong;
  return keep(satellite, times.toe, times.toc, e);
}

MessageUse NovAtelNavigationReader::galileo_fnav(NovAtelFields f, geo::GpsTime now) {
  KeplerEphemeris e;
  e.sources = kFnavSources;
  const auto satellite = novatel_satellite(System::kGalileo, f.u32());
  const int health = f.u8() & 3, valid = f.u8() & 1;
  for (int i = 0; i < 2; ++i) static_cast<void>(f.u8());
  e.health = valid << 3 | health << 4;
  const GalileoTimes times = read_galileo(f, now, e);
  if (!f.good()) return MessageUse::kWrong;
  return keep(satellite, times.toe, times.toc, e);
}

/// IONUTC: the coefficients of Klobuchar's model come first.
MessageUse NovAtelNavigationReader::ionosphere(NovAtelFields f) {
  constexpr double kMostAlpha = 1e-2, kMostBeta = 1e9;
  record::Klobuchar k;
  bool possible = true;
  for (double& alpha : k.alpha) possible = std::abs(alpha = f.f64()) < kMostAlpha && possible;
  for (double& beta : k.beta) possible = std::abs(beta = f.f64()) < kMostBeta && possible;
  if (!f.good()) return MessageUse::kWrong;
  if (!possible) return MessageUse::kImpossible;
  if (!recording_.gps_ionosphere) recording_.gps_ionosphere = k;
  return MessageUse::kEphemeris;
}

void NovAtelNavigationReader::refuse() const {
  throw InputError({stream_.name(), 0, "NovAtel logs without a whole ephemeris",
                    "RAWEPHEM or GPSEPHEM, GLOEPHEMERIS, GALINAVEPHEMERIS, BDSEPHEMERIS or QZSSEPHEMERIS",
                    "Log them with ONCHANGED, or give a RINEX navigation file."});
}

void NovAtelNavigationReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = stream_.events();
  const auto add = [&](long number, const char* kind, const char* what, Grade severity) {
    add_counted(recording_.events, recording_.source, {number},
                {kind, "navigation message", "navigation messages", what, severity});
  };
  add(spoiled_, "navigation_spoiled", "with a wrong content, length or week left out", Grade::kWarning);
  add(impossible_, "navigation_impossible", "with an impossible orbit or clock left out", Grade::kWarning);
  add(no_week_, "navigation_no_week", "before the receiver knew the week left out", Grade::kInfo);
  add(unknown_, "navigation_unknown", "of unknown satellites left out", Grade::kInfo);
}

}  // namespace

record::NavigationRecording read_novatel_navigation(const std::filesystem::path& file) {
  return NovAtelNavigationReader(file).read();
}

}  // namespace coast::io
