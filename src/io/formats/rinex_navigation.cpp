#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "../counted.hpp"
#include "../ephemerides.hpp"
#include "../file_kind.hpp"
#include "../registry_lookup.hpp"
#include "../rinex_lines.hpp"
#include "../text.hpp"
#include "coast/io/rinex.hpp"

namespace coast::io {

namespace {

using record::KeplerEphemeris;
using record::Satellite;
using record::SatelliteSystem;
using record::TabulatedEphemeris;

constexpr std::size_t kMessageWidth = 19;  // of a number
constexpr std::size_t kLargestMessage = 31;

/// The numbers of one message, in the order of the file, with its time.
struct Message {
  Satellite satellite;
  geo::GpsTime t;
  std::array<double, kLargestMessage> values{};  ///< blank: 0
  std::size_t lines = 0;                         ///< after the first
};

class NavigationReader {
 public:
  explicit NavigationReader(const std::filesystem::path& file) : lines_(file) {}

  record::NavigationRecording read() {
    recording_.source = lines_.name();
    read_header();
    while (read_message()) {
    }
    repeated_ = sort_out(recording_);
    if (recording_.kepler.empty() && recording_.tabulated.empty())
      lines_.refuse("no ephemeris that can be used", "at least one");
    report();
    return std::move(recording_);
  }

 private:
  void read_header();
  void read_header_line(std::string_view line, std::string_view label);
  [[nodiscard]] bool read_message();
  [[nodiscard]] bool skip_to_next();
  void read_ionosphere(std::string_view line);
  [[nodiscard]] std::optional<Message> numbers_of(std::string_view line);
  [[nodiscard]] std::optional<geo::GpsTime> time_of(std::string_view line, SatelliteSystem system) const;
  void keep(const Message& m);
  void keep_kepler(const Message& m);
  void keep_tabulated(const Message& m);
  void report();

  RinexLines lines_;
  record::NavigationRecording recording_;
  int major_ = 0;
  char system_ = 'G';
  long unknown_ = 0, impossible_ = 0, spoiled_ = 0, repeated_ = 0;
};

void NavigationReader::read_header() {
  const RinexKind kind = read_kind(lines_);
  major_ = kind.major;
  if (kind.type != 'N' && !(major_ == 2 && (kind.type == 'G' || kind.type == 'H')))
    lines_.refuse(fmt::format("a file of type {}", kind.stated), "navigation messages",
                  "Observations belong under `rover` and `base`.");
  if (major_ == 2) system_ = kind.type == 'G' ? 'R' : kind.type == 'H' ? 'S' : 'G';
  std::string_view line;
  while (lines_.next(line)) {
    const std::string_view label = label_of(line);
    if (label == "END OF HEADER") return;
    read_header_line(line, label);
  }
  lines_.refuse("the end of the file", "END OF HEADER", "The header is cut off.");
}

void NavigationReader::read_header_line(std::string_view line, std::string_view label) {
  constexpr std::size_t kNumber = 12;
  const std::string_view kind = trimmed(field(line, 0, 4));
  const bool alpha = label == "ION ALPHA" || (label == "IONOSPHERIC CORR" && kind == "GPSA");
  const bool beta = label == "ION BETA" || (label == "IONOSPHERIC CORR" && kind == "GPSB");
  if (!alpha && !beta) return;
  const std::size_t first = label == "IONOSPHERIC CORR" ? 5 : 2;
  if (!recording_.gps_ionosphere) recording_.gps_ionosphere.emplace();
  auto& of = alpha ? recording_.gps_ionosphere->alpha : recording_.gps_ionosphere->beta;
  for (std::size_t i = 0; i < of.size(); ++i) of.at(i) = number_field(line, first + kNumber * i, kNumber).value_or(0.0);
}

/// RINEX 4 has a line with the kind of message before each message.
bool NavigationReader::read_message() {
  std::string_view line;
  do {
    if (!lines_.next(line)) return false;
  } while (trimmed(line).empty());
  if (major_ >= 4) {
    if (line[0] != '>') lines_.refuse(in_quotes(line), "a line that begins with '>'");
    const std::string_view record = field(line, 2, 3);
    const std::string_view kind = trimmed(field(line, 10, 4));
    if (record == "ION" && kind == "LNAV") {
      read_ionosphere(line);
      return true;
    }
    constexpr std::array<std::string_view, 7> kKnown{"LNAV", "INAV", "FNAV", "D1", "D2", "FDMA", "SBAS"};
    if (record != "EPH" || std::ranges::find(kKnown, kind) == kKnown.end()) {
      if (record == "EPH") ++unknown_;
      return skip_to_next();
    }
    if (!lines_.next(line)) return false;
  }
  if (const auto message = numbers_of(line)) keep(*message);
  return true;
}

bool NavigationReader::skip_to_next() {
  std::string_view line;
  while (lines_.next(line)) {
    if (line.empty() || line[0] != '>') continue;
    lines_.put_back();
    return true;
  }
  return false;
}

void NavigationReader::read_ionosphere(std::string_view line) {
  const bool gps = field(line, 6, 1) == "G";
  std::array<double, 8> values{};
  std::size_t at = 0;
  for (const std::size_t from : {1U, 0U, 0U}) {
    if (!lines_.next(line)) return;
    for (std::size_t i = from; i < 4 && at < values.size(); ++i)
      values.at(at++) = number_field(line, 4 + kMessageWidth * i, kMessageWidth).value_or(0.0);
  }
  if (!gps) return;
  recording_.gps_ionosphere.emplace();
  std::copy_n(values.begin(), 4, recording_.gps_ionosphere->alpha.begin());
  std::copy_n(values.begin() + 4, 4, recording_.gps_ionosphere->beta.begin());
}

std::optional<geo::GpsTime> NavigationReader::time_of(std::string_view line, SatelliteSystem system) const {
  const bool two = major_ == 2;
  std::array<std::optional<int>, 5> date;  // year to minute
  date[0] = integer_field(line, two ? 2 : 4, two ? 3 : 4);
  for (std::size_t i = 1; i < date.size(); ++i) date.at(i) = integer_field(line, (two ? 2 : 5) + 3 * i, 3);
  const auto second = number_field(line, two ? 17 : 20, two ? 5 : 3);
  if (!second || std::ranges::any_of(date, [](const auto& v) { return !v; })) return std::nullopt;
  const RinexTime scale = system == SatelliteSystem::kGlonass  ? RinexTime::kUtc
                          : system == SatelliteSystem::kBeidou ? RinexTime::kBeidou
                                                               : RinexTime::kGps;
  return gps_time({full_year(*date[0]), *date[1], *date[2], *date[3], *date[4], *second}, scale);
}

/// The lines of a message: the first with satellite and time, the others indented.
std::optional<Message> NavigationReader::numbers_of(std::string_view line) {
  const bool two = major_ == 2;
  const std::size_t indent = two ? 3 : 4;
  const auto satellite = satellite_field(field(line, 0, two ? 2 : 3), system_);
  const auto t = satellite ? time_of(line, satellite->system) : std::nullopt;
  Message message;
  if (t) message = {*satellite, *t, {}, 0};
  bool whole = t.has_value();
  std::size_t next = 0;
  const auto take = [&](std::size_t at) {
    if (next < message.values.size()) {
      const std::string_view text = trimmed(field(line, at, kMessageWidth));
      const auto value = number_field(line, at, kMessageWidth);
      whole = whole && (value || text.empty());
      message.values.at(next) = value.value_or(0.0);
    }
    ++next;
  };
  const std::size_t first = two ? 22 : 23;
  for (std::size_t i = 0; i < 3; ++i) take(first + kMessageWidth * i);
  while (lines_.next(line)) {
    if (line.size() < indent || !trimmed(line.substr(0, indent)).empty()) {
      if (!trimmed(line).empty()) {
        lines_.put_back();
        break;
      }
      continue;
    }
    for (std::size_t i = 0; i < 4; ++i) take(indent + kMessageWidth * i);
    ++message.lines;
  }
  if (whole) return message;
  ++spoiled_;
  return std::nullopt;
}

void NavigationReader::keep(const Message& m) {
  constexpr std::size_t kTabulatedLines = 3;
  constexpr std::size_t kKeplerLines = 7;
  const bool tabulated = m.satellite.system == SatelliteSystem::kGlonass || m.satellite.system == SatelliteSystem::kSbas;
  if (m.satellite.system == SatelliteSystem::kNavic)
    ++unknown_;
  else if (m.lines < (tabulated ? kTabulatedLines : kKeplerLines))
    ++spoiled_;
  else if (tabulated)
    keep_tabulated(m);
  else
    keep_kepler(m);
}

void NavigationReader::keep_kepler(const Message& m) {
  const auto& v = m.values;
  const bool beidou = m.satellite.system == SatelliteSystem::kBeidou;
  KeplerEphemeris e;
  e.satellite = m.satellite;
  e.toc = m.t;
  e.clock = {v[0], v[1], v[2]};
  e.issue = static_cast<int>(std::clamp(v[3], 0.0, 4096.0));
  e.crs = v[4];
  e.delta_n = v[5];
  e.mean_anomaly = v[6];
  e.cuc = v[7];
  e.eccentricity = v[8];
  e.cus = v[9];
  e.sqrt_a = v[10];
  // The week of the file is not used, as some programs write it modulo 1024.
  e.toe = nearest_second_of_week(m.t, v[11] + (beidou ? kGpsMinusBeidou : 0.0));
  e.cic = v[12];
  e.node = v[13];
  e.cis = v[14];
  e.inclination = v[15];
  e.crc = v[16];
  e.perigee = v[17];
  e.node_rate = v[18];
  e.inclination_rate = v[19];
  e.sources = static_cast<int>(std::clamp(v[20], 0.0, 65535.0));
  e.accuracy_m = v[23];
  e.health = static_cast<int>(std::clamp(v[24], 0.0, 65535.0));
  e.group_delay = {v[25], v[26]};
  if (m.satellite.system == SatelliteSystem::kGps || m.satellite.system == SatelliteSystem::kQzss)
    e.group_delay[1] = 0.0;  // this field is the issue of the clock there
  constexpr double kWeek = 604800.0;
  if (!is_possible(e) || !(v[11] >= 0.0 && v[11] <= kWeek)) {
    ++impossible_;
    return;
  }
  recording_.kepler.push_back(e);
}

void NavigationReader::keep_tabulated(const Message& m) {
  constexpr double kKilometre = 1000.0;
  const auto& v = m.values;
  TabulatedEphemeris e;
  e.satellite = m.satellite;
  e.t = m.t;
  e.clock_bias = v[0];
  e.clock_drift = v[1];
  e.r_e = kKilometre * Eigen::Vector3d(v[3], v[7], v[11]);
  e.v_e = kKilometre * Eigen::Vector3d(v[4], v[8], v[12]);
  e.a_e = kKilometre * Eigen::Vector3d(v[5], v[9], v[13]);
  e.health = static_cast<int>(std::clamp(v[6], 0.0, 65535.0));
  if (m.satellite.system == SatelliteSystem::kGlonass)
    e.channel = static_cast<int>(std::clamp(v[10], -99.0, 300.0));
  else
    e.accuracy_m = v[10];
  if (e.channel > 128) e.channel -= 256;  // some programs write the byte unsigned
  if (!is_possible(e)) {
    ++impossible_;
    return;
  }
  recording_.tabulated.push_back(e);
}

void NavigationReader::report() {
  recording_.events = lines_.events();
  const auto add = [&](long number, const char* kind, const char* what, record::Event::Severity severity) {
    add_counted(recording_.events, recording_.source, {number}, {kind, "message", "messages", what, severity});
  };
  const auto warning = record::Event::Severity::kWarning;
  const auto info = record::Event::Severity::kInfo;
  add(spoiled_, "navigation_spoiled", "that cannot be read left out", warning);
  add(impossible_, "navigation_impossible", "with an impossible orbit or clock left out", warning);
  add(unknown_, "navigation_unknown", "of a kind that is not used", info);
  add(repeated_, "navigation_repeated", "that repeat another left out", info);
}

}  // namespace

record::NavigationRecording read_navigation(const std::filesystem::path& file) {
  if (const Format* format = format_beside_rinex(file, &Format::read_navigation)) return format->read_navigation(file);
  return read_as(file, FileKind::Content::kRinex, "RINEX navigation messages", [&] { return NavigationReader(file).read(); });
}

std::optional<geo::GpsTime> middle_of(const record::NavigationRecording& navigation) {
  std::vector<geo::GpsTime> times;
  for (const KeplerEphemeris& e : navigation.kepler) times.push_back(e.toe);
  for (const TabulatedEphemeris& e : navigation.tabulated) times.push_back(e.t);
  if (times.empty()) return std::nullopt;
  const auto [first, last] = std::ranges::minmax(times);
  return first + 0.5 * (last - first);
}

record::NavigationRecording read_navigation(const std::vector<std::filesystem::path>& files) {
  record::NavigationRecording all;
  for (const std::filesystem::path& file : files) {
    record::NavigationRecording one = read_navigation(file);
    std::ranges::move(one.kepler, std::back_inserter(all.kepler));
    std::ranges::move(one.tabulated, std::back_inserter(all.tabulated));
    std::ranges::move(one.events, std::back_inserter(all.events));
    if (!all.gps_ionosphere) all.gps_ionosphere = one.gps_ionosphere;
    all.source += (all.source.empty() ? "" : ", ") + one.source;
  }
  static_cast<void>(sort_out(all));  // days overlap
  return all;
}

}  // namespace coast::io
