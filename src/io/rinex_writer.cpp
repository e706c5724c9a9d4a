// RINEX 3.05 and 4.01 files (IGS/RTCM RINEX WG), which differ in the first line and in the line before a navigation message.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "coast/io/rinex.hpp"
#include "coast/io/writers.hpp"
#include "ephemerides.hpp"
#include "rinex_lines.hpp"

namespace coast::io {

namespace {

using record::Observation;
using record::Satellite;
using record::SatelliteSystem;
using record::Signal;

/// "text ...   LABEL": sixty columns of text.
std::string header_line(const std::string& text, std::string_view label) {
  return fmt::format("{:<60.60}{:<20}\n", text, label);
}

std::string first_line(RinexVersion version, const char* type, const char* system) {
  return header_line(fmt::format("{:>9}{:11}{:<20}{:<20}", version == RinexVersion::kThree ? "3.05" : "4.01", "", type, system),
                     "RINEX VERSION / TYPE") +
         header_line(fmt::format("{:<20}", "coast"), "PGM / RUN BY / DATE");
}

/// "C1C", "L1C", ... of each system, and their positions.
struct Columns {
  struct Column {
    Signal signal;
    char quantity;
  };
  std::map<SatelliteSystem, std::vector<Column>> of;

  explicit Columns(const record::ObservationRecording& recording) {
    std::map<SatelliteSystem, std::set<Signal>> signals;
    std::set<char> quantities;
    for (const record::ObservationEpoch& epoch : recording.epochs)
      for (const Observation& o : epoch.observations) {
        signals[o.satellite.system].insert(o.signal);
        if (o.code_m) quantities.insert('C');
        if (o.phase_cycles) quantities.insert('L');
        if (o.doppler_hz) quantities.insert('D');
        if (o.cn0_dbhz) quantities.insert('S');
      }
    for (const auto& [system, all] : signals)
      for (const Signal signal : all)
        for (const char quantity : {'C', 'L', 'D', 'S'})
          if (quantities.contains(quantity)) of[system].push_back({signal, quantity});
  }
};

std::string types_lines(const Columns& columns) {
  constexpr std::size_t kInLine = 13;
  std::string text;
  for (const auto& [system, all] : columns.of) {
    std::string line = fmt::format("{}  {:>3}", record::letter(system), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i > 0 && i % kInLine == 0) {
        text += header_line(line, "SYS / # / OBS TYPES");
        line = "      ";
      }
      line += fmt::format(" {}{}{}", all[i].quantity, all[i].signal.band, all[i].signal.tracking);
    }
    text += header_line(line, "SYS / # / OBS TYPES");
  }
  return text;
}

std::string channel_lines(const record::ObservationRecording& recording) {
  constexpr std::size_t kInLine = 8;
  if (recording.glonass_channels.empty()) return "";
  std::string text, line = fmt::format("{:>3} ", recording.glonass_channels.size());
  std::size_t n = 0;
  for (const auto& [slot, channel] : recording.glonass_channels) {
    if (n > 0 && n % kInLine == 0) {
      text += header_line(line, "GLONASS SLOT / FRQ #");
      line = "    ";
    }
    line += fmt::format("R{:02d} {:>2} ", slot, channel);
    ++n;
  }
  return text + header_line(line, "GLONASS SLOT / FRQ #");
}

std::string observation_header(const record::ObservationRecording& recording, const Columns& columns, RinexVersion version) {
  const geo::Calendar first = recording.epochs.empty() ? geo::Calendar{} : recording.epochs.front().t.calendar();
  const Eigen::Vector3d r = recording.approximate_r_e.value_or(Eigen::Vector3d::Zero());
  const Eigen::Vector3d& enu = recording.antenna_offset_enu;
  return first_line(version, "OBSERVATION DATA", "M: MIXED") + header_line(recording.marker, "MARKER NAME") +
         header_line(fmt::format("{:20}{:<20}", "", recording.receiver), "REC # / TYPE / VERS") +
         header_line(fmt::format("{:20}{:<20}", "", recording.antenna), "ANT # / TYPE") +
         header_line(fmt::format("{:14.4f}{:14.4f}{:14.4f}", r.x(), r.y(), r.z()), "APPROX POSITION XYZ") +
         header_line(fmt::format("{:14.4f}{:14.4f}{:14.4f}", enu.z(), enu.x(), enu.y()), "ANTENNA: DELTA H/E/N") +
         types_lines(columns) +
         header_line(fmt::format("{:6}{:6}{:6}{:6}{:6}{:13.7f}     GPS", first.year, first.month, first.day, first.hour,
                                 first.minute, first.second),
                     "TIME OF FIRST OBS") +
         channel_lines(recording) + header_line("", "END OF HEADER");
}

std::optional<double> quantity_of(const Observation& o, char quantity) {
  switch (quantity) {
    case 'C':
      return o.code_m;
    case 'L':
      return o.phase_cycles;
    case 'D':
      return o.doppler_hz;
    default:
      return o.cn0_dbhz;
  }
}

void put_observation(std::string& text, const Observation* o, char quantity) {
  const std::optional<double> value = o == nullptr ? std::nullopt : quantity_of(*o, quantity);
  if (!value) {
    text.append(16, ' ');
    return;
  }
  const int flags = quantity == 'L' ? (o->lost_lock ? 1 : 0) + (o->half_cycle ? 2 : 0) : 0;
  fmt::format_to(std::back_inserter(text), "{:14.3f}{} ", *value, flags > 0 ? std::to_string(flags) : " ");
}

void put_epoch(std::string& text, const record::ObservationEpoch& epoch, const Columns& columns) {
  std::map<Satellite, std::map<Signal, const Observation*>> satellites;
  for (const Observation& o : epoch.observations) satellites[o.satellite][o.signal] = &o;
  const geo::Calendar c = epoch.t.calendar();
  fmt::format_to(std::back_inserter(text), "> {:04} {:02} {:02} {:02} {:02}{:11.7f}  0{:3}\n", c.year, c.month, c.day, c.hour,
                 c.minute, c.second, satellites.size());
  for (const auto& [satellite, signals] : satellites) {
    text += to_string(satellite);
    for (const Columns::Column& column : columns.of.at(satellite.system)) {
      const auto found = signals.find(column.signal);
      put_observation(text, found == signals.end() ? nullptr : found->second, column.quantity);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
}

/// "0.123456789012E-03" including the leading digit: 19 columns, exponent of two digits.
std::string number19(double value) {
  return fmt::format("{:19.12E}", value);
}

std::string message_head(Satellite satellite, const geo::Calendar& c, RinexVersion version, const char* kind) {
  std::string head;
  if (version == RinexVersion::kFour) head = fmt::format("> EPH {} {}\n", to_string(satellite), kind);
  return head + fmt::format("{} {:04} {:02} {:02} {:02} {:02} {:02.0f}", to_string(satellite), c.year, c.month, c.day, c.hour,
                            c.minute, c.second);
}

template <std::size_t N>
std::string message_lines(const std::array<double, N>& values) {
  std::string text;
  for (std::size_t i = 0; i < N; ++i) {
    if (i >= 3 && (i - 3) % 4 == 0) text += "\n    ";
    text += number19(values.at(i));
  }
  return text + '\n';
}

const char* kind_of(const record::KeplerEphemeris& e) {
  constexpr int kFnav = 2;
  switch (e.satellite.system) {
    case SatelliteSystem::kGalileo:
      return (e.sources & kFnav) != 0 ? "FNAV" : "INAV";
    case SatelliteSystem::kBeidou:
      return is_beidou_geostationary(e.satellite) ? "D2" : "D1";
    default:
      return "LNAV";
  }
}

std::string message(const record::KeplerEphemeris& e, RinexVersion version) {
  const bool beidou = e.satellite.system == SatelliteSystem::kBeidou;
  const double behind = beidou ? kGpsMinusBeidou : 0.0;
  const geo::GpsTime toe = e.toe - behind;
  const int week = toe.week() - (beidou ? kBeidouFirstWeek : 0);
  return message_head(e.satellite, (e.toc - behind).calendar(), version, kind_of(e)) +
         message_lines(std::array<double, 29>{e.clock[0],
                                              e.clock[1],
                                              e.clock[2],
                                              static_cast<double>(e.issue),
                                              e.crs,
                                              e.delta_n,
                                              e.mean_anomaly,
                                              e.cuc,
                                              e.eccentricity,
                                              e.cus,
                                              e.sqrt_a,
                                              toe.sow(),
                                              e.cic,
                                              e.node,
                                              e.cis,
                                              e.inclination,
                                              e.crc,
                                              e.perigee,
                                              e.node_rate,
                                              e.inclination_rate,
                                              static_cast<double>(e.sources),
                                              static_cast<double>(week),
                                              0.0,
                                              e.accuracy_m,
                                              static_cast<double>(e.health),
                                              e.group_delay[0],
                                              e.group_delay[1],
                                              toe.sow(),
                                              0.0});
}

std::string message(const record::TabulatedEphemeris& e, RinexVersion version) {
  constexpr double kKilometre = 1000.0;
  const bool glonass = e.satellite.system == SatelliteSystem::kGlonass;
  const Eigen::Vector3d r = e.r_e / kKilometre, v = e.v_e / kKilometre, a = e.a_e / kKilometre;
  return message_head(e.satellite, glonass ? e.t.utc() : e.t.calendar(), version, glonass ? "FDMA" : "SBAS") +
         message_lines(std::array<double, 15>{
             e.clock_bias, e.clock_drift, e.t.sow(), r.x(), v.x(), a.x(), static_cast<double>(e.health), r.y(), v.y(), a.y(),
             glonass ? static_cast<double>(e.channel) : e.accuracy_m, r.z(), v.z(), a.z(), 0.0});
}

}  // namespace

void write_observations(const std::filesystem::path& file, const record::ObservationRecording& recording,
                        RinexVersion version) {
  constexpr std::size_t kPiece = 1 << 16;
  const Columns columns(recording);
  AtomicFile out(file);
  std::string text = observation_header(recording, columns, version);
  for (const record::ObservationEpoch& epoch : recording.epochs) {
    put_epoch(text, epoch, columns);
    if (text.size() < kPiece) continue;
    out.write(text);
    text.clear();
  }
  out.write(text);
  out.commit();
}

void write_navigation(const std::filesystem::path& file, const record::NavigationRecording& navigation, RinexVersion version) {
  std::string text = first_line(version, "N: GNSS NAV DATA", "M: MIXED");
  if (navigation.gps_ionosphere && version == RinexVersion::kThree)
    for (const auto& [name, values] :
         {std::pair("GPSA", navigation.gps_ionosphere->alpha), std::pair("GPSB", navigation.gps_ionosphere->beta)})
      text += header_line(fmt::format("{} {:12.4E}{:12.4E}{:12.4E}{:12.4E}", name, values[0], values[1], values[2], values[3]),
                          "IONOSPHERIC CORR");
  text += header_line("", "END OF HEADER");
  for (const record::KeplerEphemeris& e : navigation.kepler) text += message(e, version);
  for (const record::TabulatedEphemeris& e : navigation.tabulated) text += message(e, version);
  write_text(file, text);
}

}  // namespace coast::io
