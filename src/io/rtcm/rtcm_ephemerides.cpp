#include "rtcm_ephemerides.hpp"

#include <cmath>

#include "../broadcast/bit_field.hpp"
#include "../ephemerides.hpp"
#include "coast/geo/units.hpp"
#include "rtcm_messages.hpp"

namespace coast::io {

namespace {

using record::KeplerEphemeris;
using record::Satellite;
using System = record::SatelliteSystem;

constexpr std::size_t kAfterNumber = 12;
constexpr int kRtcmChannelOffset = 7;

double turns(BitCursor& c, std::size_t bits, int exponent) {
  return geo::kPi * c.signed_number(bits, exponent);
}

/// Widths and scales of the orbit, which differ between BeiDou and the others.
struct OrbitScale {
  std::size_t harmonic_bits;
  int radius, angle;  ///< exponents
  std::size_t time_bits;
  double time_unit;  ///< s
  double behind;     ///< GPS time minus that of the message
};
constexpr OrbitScale kGpsScale{16, -5, -29, 16, 16.0, 0.0};
constexpr OrbitScale kGalileoScale{16, -5, -29, 14, 60.0, 0.0};
constexpr OrbitScale kBeidouScale{18, -6, -31, 17, 8.0, kGpsMinusBeidou};

geo::GpsTime next_time(BitCursor& c, const OrbitScale& scale, geo::GpsTime now) {
  return nearest_second_of_week(now - scale.behind, scale.time_unit * c.number(scale.time_bits, 0)) + scale.behind;
}

/// From crs to the rate of the node: the same order in all of these messages.
void read_rtcm_orbit(BitCursor& c, const OrbitScale& scale, geo::GpsTime now, KeplerEphemeris& e) {
  e.crs = c.signed_number(scale.harmonic_bits, scale.radius);
  e.delta_n = turns(c, 16, -43);
  e.mean_anomaly = turns(c, 32, -31);
  e.cuc = c.signed_number(scale.harmonic_bits, scale.angle);
  e.eccentricity = c.number(32, -33);
  e.cus = c.signed_number(scale.harmonic_bits, scale.angle);
  e.sqrt_a = c.number(32, -19);
  e.toe = next_time(c, scale, now);
  e.cic = c.signed_number(scale.harmonic_bits, scale.angle);
  e.node = turns(c, 32, -31);
  e.cis = c.signed_number(scale.harmonic_bits, scale.angle);
  e.inclination = turns(c, 32, -31);
  e.crc = c.signed_number(scale.harmonic_bits, scale.radius);
  e.perigee = turns(c, 32, -31);
  e.node_rate = turns(c, 24, -43);
}

void read_gps(BitCursor c, geo::GpsTime now, KeplerEphemeris& e) {
  e.satellite = {System::kGps, static_cast<std::uint8_t>(c.integer(6))};
  c.skip(10);  // week
  e.accuracy_m = accuracy_of_ura(c.integer(4));
  e.sources = c.integer(2);
  e.inclination_rate = turns(c, 14, -43);
  e.issue = c.integer(8);
  e.toc = next_time(c, kGpsScale, now);
  e.clock[2] = c.signed_number(8, -55);
  e.clock[1] = c.signed_number(16, -43);
  e.clock[0] = c.signed_number(22, -31);
  c.skip(10);  // IODC
  read_rtcm_orbit(c, kGpsScale, now, e);
  e.group_delay[0] = c.signed_number(8, -31);
  e.health = c.integer(6);
}

void read_qzss(BitCursor c, geo::GpsTime now, KeplerEphemeris& e) {
  e.satellite = {System::kQzss, static_cast<std::uint8_t>(c.integer(4))};
  e.toc = next_time(c, kGpsScale, now);
  e.clock[2] = c.signed_number(8, -55);
  e.clock[1] = c.signed_number(16, -43);
  e.clock[0] = c.signed_number(22, -31);
  e.issue = c.integer(8);
  read_rtcm_orbit(c, kGpsScale, now, e);
  e.inclination_rate = turns(c, 14, -43);
  e.sources = c.integer(2);
  c.skip(10);  // week
  e.accuracy_m = accuracy_of_ura(c.integer(4));
  e.health = c.integer(6);
  e.group_delay[0] = c.signed_number(8, -31);
}

/// Group delays are in 0.1 ns.
void read_beidou(BitCursor c, geo::GpsTime now, KeplerEphemeris& e) {
  constexpr double kDelay = 1e-10;
  e.satellite = {System::kBeidou, static_cast<std::uint8_t>(c.integer(6))};
  c.skip(13);  // week
  e.accuracy_m = accuracy_of_ura(c.integer(4));
  e.inclination_rate = turns(c, 14, -43);
  e.issue = c.integer(5);
  e.toc = next_time(c, kBeidouScale, now);
  e.clock[2] = c.signed_number(11, -66);
  e.clock[1] = c.signed_number(22, -50);
  e.clock[0] = c.signed_number(24, -33);
  c.skip(5);  // AODC
  read_rtcm_orbit(c, kBeidouScale, now, e);
  e.group_delay[0] = kDelay * c.signed_integer(10);
  e.group_delay[1] = kDelay * c.signed_integer(10);
  e.health = c.integer(1);
}

/// Sources and health in the bits of RINEX 3.05, table A8.
void read_galileo(BitCursor c, bool inav, geo::GpsTime now, KeplerEphemeris& e) {
  constexpr int kInavSources = 1 | 1 << 2 | 1 << 9, kFnavSources = 1 << 1 | 1 << 8;
  e.satellite = {System::kGalileo, static_cast<std::uint8_t>(c.integer(6))};
  e.sources = inav ? kInavSources : kFnavSources;
  c.skip(12);  // week
  e.issue = c.integer(10);
  e.accuracy_m = accuracy_of_sisa(c.integer(8));
  e.inclination_rate = turns(c, 14, -43);
  e.toc = next_time(c, kGalileoScale, now);
  e.clock[2] = c.signed_number(6, -59);
  e.clock[1] = c.signed_number(21, -46);
  e.clock[0] = c.signed_number(31, -34);
  read_rtcm_orbit(c, kGalileoScale, now, e);
  e.group_delay[0] = c.signed_number(10, -32);
  if (inav) e.group_delay[1] = c.signed_number(10, -32);
  const int first_health = c.integer(2), first_valid = c.integer(1);  // E5a, or E5b
  if (!inav) {
    e.health = first_valid << 3 | first_health << 4;
    return;
  }
  const int e1_health = c.integer(2), e1_valid = c.integer(1);
  e.health = e1_valid | e1_health << 1 | first_valid << 6 | first_health << 7;
}

/// Shortest message that has all fields, in bytes.
std::size_t ephemeris_bytes(std::uint32_t id) {
  switch (id) {
    case rtcm::kGpsEphemeris:
      return 61;
    case rtcm::kGlonassEphemeris:
      return 45;
    case rtcm::kBeidouEphemeris:
      return 64;
    case rtcm::kQzssEphemeris:
      return 61;
    case rtcm::kGalileoFnav:
      return 62;
    case rtcm::kGalileoInav:
      return 63;
    default:
      return 0;
  }
}

int last_number(System system) {
  switch (system) {
    case System::kGps:
      return 32;
    case System::kQzss:
      return 10;
    case System::kBeidou:
      return 63;
    default:
      return 36;
  }
}

std::optional<KeplerEphemeris> kepler_in(const MessageFrame& frame, geo::GpsTime now) {
  const BitField bits = bits_of(frame.payload);
  const BitCursor c(bits, kAfterNumber);
  KeplerEphemeris e;
  if (frame.id == rtcm::kGpsEphemeris) read_gps(c, now, e);
  if (frame.id == rtcm::kQzssEphemeris) read_qzss(c, now, e);
  if (frame.id == rtcm::kBeidouEphemeris) read_beidou(c, now, e);
  if (frame.id == rtcm::kGalileoFnav) read_galileo(c, false, now, e);
  if (frame.id == rtcm::kGalileoInav) read_galileo(c, true, now, e);
  if (e.satellite.number < 1 || e.satellite.number > last_number(e.satellite.system)) return std::nullopt;
  return e;
}

/// The week is that of the transmission, or that of the ephemeris.
bool is_of_its_week(const MessageFrame& frame, const KeplerEphemeris& e, geo::GpsTime now) {
  const auto week = rtcm_week(frame, now);
  if (!week) return false;
  const double behind = e.satellite.system == System::kBeidou ? kGpsMinusBeidou : 0.0;
  const int stated = (week->t - behind).week();
  return stated == (e.toe - behind).week() || stated == (now - geo::kHour).week() || stated == (now + geo::kHour).week();
}

}  // namespace

std::optional<MessageUse> RtcmEphemerides::take(const MessageFrame& frame, geo::GpsTime now,
                                                record::NavigationRecording& into) {
  const std::size_t bytes = frame.protocol == Protocol::kRtcm3 ? ephemeris_bytes(frame.id) : 0;
  if (bytes == 0) return std::nullopt;
  if (frame.payload.size() < bytes) return MessageUse::kWrong;
  if (frame.id == rtcm::kGlonassEphemeris) return take_glonass(frame, now, into);
  const auto e = kepler_in(frame, now);
  if (!e || !is_of_its_week(frame, *e, now)) return MessageUse::kWrong;
  // Some receivers pass on the new orbit with no clock yet.
  constexpr double kHalfDay = 43200.0;
  if (std::abs(e->toc - e->toe) > kHalfDay) return MessageUse::kWrong;
  return give(*e, given_[{e->satellite, e->sources}], into);
}

/// 1020, 3.5.10: strings 1 to 4 in the order of their bits. t_b counts quarters of an hour of the day in Moscow.
MessageUse RtcmEphemerides::take_glonass(const MessageFrame& frame, geo::GpsTime now, record::NavigationRecording& into) {
  constexpr double kKilometre = 1000.0, kQuarter = 900.0;
  constexpr std::size_t kMalfunction = 39, kSecond = 41;  // B_n; t_b
  const auto channel = channel_in_ephemeris(frame);
  if (!channel) return MessageUse::kWrong;
  const BitField bits = bits_of(frame.payload);
  BitCursor c(bits, kSecond);
  record::TabulatedEphemeris e;
  e.satellite = {System::kGlonass, static_cast<std::uint8_t>(channel->first)};
  e.channel = channel->second;
  e.t = nearest_second_of_moscow_day(now, kQuarter * c.integer(7));
  for (int axis = 0; axis < 3; ++axis) {
    e.v_e(axis) = kKilometre * c.magnitude_number(24, -20);
    e.r_e(axis) = kKilometre * c.magnitude_number(27, -11);
    e.a_e(axis) = kKilometre * c.magnitude_number(5, -30);
  }
  c.skip(1);  // P3
  e.clock_drift = c.magnitude_number(11, -40);
  c.skip(2);  // P
  const int third = c.integer(1);
  e.clock_bias = -c.magnitude_number(22, -30);
  e.health = bits.bits(kMalfunction, 1) != 0 || third != 0 ? 1 : 0;
  if (!is_possible(e)) return MessageUse::kImpossible;
  const auto given = given_glonass_.find(e.satellite);
  if (given == given_glonass_.end() || given->second != e.t) into.tabulated.push_back(e);
  given_glonass_[e.satellite] = e.t;
  return MessageUse::kEphemeris;
}

std::optional<std::pair<int, int>> channel_in_ephemeris(const MessageFrame& frame) {
  constexpr int kLastSlot = 32, kChannels = 21;  // to 13, as satellites had before 2005
  if (frame.protocol != Protocol::kRtcm3 || frame.id != rtcm::kGlonassEphemeris ||
      frame.payload.size() < ephemeris_bytes(rtcm::kGlonassEphemeris))
    return std::nullopt;
  const BitField bits = bits_of(frame.payload);
  BitCursor c(bits, kAfterNumber);
  const int slot = c.integer(6), channel = c.integer(5);
  if (slot < 1 || slot > kLastSlot || channel >= kChannels) return std::nullopt;
  return std::pair(slot, channel - kRtcmChannelOffset);
}

}  // namespace coast::io
