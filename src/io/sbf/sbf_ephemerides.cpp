// Fields of mosaic-X5 reference guide 4.14.10, 4.2.3 to 4.2.8. Angles are in semicircles, and GLONASS in kilometres.

#include "sbf_ephemerides.hpp"

#include <algorithm>
#include <cmath>

#include "../ephemerides.hpp"
#include "../rinex_lines.hpp"
#include "coast/geo/units.hpp"
#include "sbf_blocks.hpp"
#include "sbf_signals.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr std::size_t kSbfKepler = 132;  // payload of GPSNav, QZSNav and BDSNav

/// Group delays may be unknown.
double known_or_zero(double value) {
  return sbf_known(value) ? value : 0.0;
}

/// Times are within half a week of each other, and the ephemeris of that of its reception.
void set_times(record::KeplerEphemeris& e, double toe_sow, double toc_sow, geo::GpsTime now) {
  e.toe = nearest_second_of_week(now, toe_sow);
  e.toc = nearest_second_of_week(e.toe, toc_sow);
}

/// From t_oc to IDOT, which GPS and BeiDou have alike.
/// @param behind  GPS time minus the system's time, s
void read_sbf_orbit(SbfFields& f, geo::GpsTime now, double behind, record::KeplerEphemeris& e) {
  const double toc = f.u4() + behind;
  e.clock[2] = f.f4();
  e.clock[1] = f.f4();
  e.clock[0] = f.f4();
  e.crs = f.f4();
  e.delta_n = geo::kPi * f.f4();
  e.mean_anomaly = geo::kPi * f.f8();
  e.cuc = f.f4();
  e.eccentricity = f.f8();
  e.cus = f.f4();
  e.sqrt_a = f.f8();
  const double toe = f.u4() + behind;
  e.cic = f.f4();
  e.node = geo::kPi * f.f8();
  e.cis = f.f4();
  e.inclination = geo::kPi * f.f8();
  e.crc = f.f4();
  e.perigee = geo::kPi * f.f8();
  e.node_rate = geo::kPi * f.f4();
  e.inclination_rate = geo::kPi * f.f4();
  set_times(e, toe, toc, now);
}

std::optional<record::Satellite> satellite_among(int svid, std::initializer_list<System> systems) {
  const auto satellite = sbf_satellite(static_cast<std::uint8_t>(svid));
  if (!satellite || std::ranges::find(systems, satellite->system) == systems.end()) return std::nullopt;
  return satellite;
}

/// The bits of RINEX 3.05, table A8, from the three of a signal that a flag calls valid: data validity, then two of health.
int galileo_health(int stated) {
  constexpr int kOnE1 = 0, kOnE5b = 4, kOnE5a = 8;  // bits of the flags
  const auto of = [&](int flag) { return (stated >> flag & 1) != 0 ? stated >> (flag + 1) & 7 : 0; };
  return of(kOnE1) | of(kOnE5a) << 3 | of(kOnE5b) << 6;
}

}  // namespace

std::optional<record::KeplerEphemeris> sbf_gps_ephemeris(std::string_view payload, geo::GpsTime now) {
  constexpr int kLowByte = 0xff;
  if (payload.size() < kSbfKepler) return std::nullopt;
  SbfFields f(payload, kSbfBody);
  const auto satellite = satellite_among(f.u1(), {System::kGps, System::kQzss});
  if (!satellite) return std::nullopt;
  record::KeplerEphemeris e;
  e.satellite = *satellite;
  f.skip(1 + 2);  // week
  e.sources = f.u1();
  e.accuracy_m = accuracy_of_ura(std::min(f.u1(), 15));
  e.health = f.u1();
  f.skip(1);
  const int issue_of_clock = f.u2();
  e.issue = f.u1();
  // Subframes of different issues are no ephemeris.
  if (f.u1() != e.issue || (issue_of_clock & kLowByte) != e.issue) return std::nullopt;
  f.skip(1 + 1);  // fit interval
  e.group_delay[0] = known_or_zero(f.f4());
  read_sbf_orbit(f, now, 0.0, e);
  return e;
}

std::optional<record::KeplerEphemeris> sbf_beidou_ephemeris(std::string_view payload, geo::GpsTime now) {
  if (payload.size() < kSbfKepler) return std::nullopt;
  SbfFields f(payload, kSbfBody);
  const auto satellite = satellite_among(f.u1(), {System::kBeidou});
  if (!satellite) return std::nullopt;
  record::KeplerEphemeris e;
  e.satellite = *satellite;
  f.skip(1 + 2);  // week
  e.accuracy_m = accuracy_of_ura(std::min(f.u1(), 15));
  e.health = f.u1();
  f.skip(1);  // age of the clock
  e.issue = f.u1();
  f.skip(2);
  for (double& delay : e.group_delay) delay = known_or_zero(f.f4());
  read_sbf_orbit(f, now, kGpsMinusBeidou, e);
  return e;
}

std::optional<record::KeplerEphemeris> sbf_galileo_ephemeris(std::string_view payload, geo::GpsTime now) {
  constexpr std::size_t kSize = 128;
  constexpr int kInav = 2, kFnav = 16;
  // I/NAV of E1-B and of E5b-I, clock of E5b and E1; F/NAV of E5a-I, clock of E5a and E1 (RINEX 3.05, table A8).
  constexpr int kInavSources = 1 | 1 << 2 | 1 << 9, kFnavSources = 1 << 1 | 1 << 8;
  if (payload.size() < kSize) return std::nullopt;
  SbfFields f(payload, kSbfBody);
  const auto satellite = satellite_among(f.u1(), {System::kGalileo});
  const int source = f.u1();
  if (!satellite || (source != kInav && source != kFnav)) return std::nullopt;
  record::KeplerEphemeris e;
  e.satellite = *satellite;
  e.sources = source == kInav ? kInavSources : kFnavSources;
  e.sqrt_a = f.f8();
  e.mean_anomaly = geo::kPi * f.f8();
  e.eccentricity = f.f8();
  e.inclination = geo::kPi * f.f8();
  e.perigee = geo::kPi * f.f8();
  e.node = geo::kPi * f.f8();
  e.node_rate = geo::kPi * f.f4();
  e.inclination_rate = geo::kPi * f.f4();
  e.delta_n = geo::kPi * f.f4();
  for (double* harmonic : {&e.cuc, &e.cus, &e.crc, &e.crs, &e.cic, &e.cis}) *harmonic = f.f4();
  const double toe = f.u4(), toc = f.u4();
  set_times(e, toe, toc, now);
  e.clock[2] = f.f4();
  e.clock[1] = f.f4();
  e.clock[0] = f.f8();
  f.skip(2 + 2);  // weeks
  e.issue = f.u2();
  e.health = galileo_health(f.u2());
  f.skip(1);
  const int with_e5a = f.u1(), with_e5b = f.u1();
  e.accuracy_m = accuracy_of_sisa(source == kInav ? with_e5b : with_e5a);
  f.skip(1);
  for (double& delay : e.group_delay) delay = known_or_zero(f.f4());
  return e;
}

std::optional<record::TabulatedEphemeris> sbf_glonass_ephemeris(std::string_view payload, geo::GpsTime now) {
  constexpr std::size_t kSize = 88;
  constexpr double kKilometre = 1000.0, kCentimetre = 0.01;
  constexpr int kUnhealthy = 4;  // the highest of three bits
  if (payload.size() < kSize) return std::nullopt;
  SbfFields f(payload, kSbfBody);
  const auto satellite = satellite_among(f.u1(), {System::kGlonass});
  const auto channel = sbf_channel(static_cast<unsigned>(f.u1()));
  if (!satellite || !channel) return std::nullopt;
  record::TabulatedEphemeris e;
  e.satellite = *satellite;
  e.channel = *channel;
  for (int i = 0; i < 3; ++i) e.r_e[i] = kKilometre * f.f8();
  for (int i = 0; i < 3; ++i) e.v_e[i] = kKilometre * f.f4();
  for (int i = 0; i < 3; ++i) e.a_e[i] = kKilometre * f.f4();
  e.clock_drift = f.f4();
  e.clock_bias = -f.f4();
  f.skip(4);  // delay between the bands
  e.t = nearest_second_of_week(now, f.u4());
  f.skip(2 + 1 + 1 + 1);  // week, P1, P2, age
  const int health = f.u1();
  f.skip(2 + 1 + 1);  // t_b, M, P
  const int malfunction = f.u1();
  f.skip(1 + 2);  // P4, N_T
  e.accuracy_m = kCentimetre * f.u2();
  e.health = (health & kUnhealthy) != 0 || malfunction != 0 ? 1 : 0;
  return e;
}

std::optional<record::Klobuchar> sbf_gps_ionosphere(std::string_view payload) {
  constexpr std::size_t kSize = 40;
  if (payload.size() < kSize) return std::nullopt;
  SbfFields f(payload, kSbfBody + 2);
  record::Klobuchar k;
  for (double& alpha : k.alpha) alpha = f.f4();
  for (double& beta : k.beta) beta = f.f4();
  if (!std::ranges::all_of(k.alpha, sbf_known) || !std::ranges::all_of(k.beta, sbf_known)) return std::nullopt;
  return k;
}

}  // namespace coast::io
