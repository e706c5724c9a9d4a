#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../counted.hpp"
#include "../file_kind.hpp"
#include "../registry_lookup.hpp"
#include "../rinex_lines.hpp"
#include "../text.hpp"
#include "coast/io/rinex.hpp"
#include "rinex_columns.hpp"

namespace coast::io {

namespace {

using record::Observation;
using record::Satellite;
using record::SatelliteSystem;
using record::Signal;

constexpr std::size_t kObservationWidth = 16;  // of a number with its two flags

class ObservationReader {
 public:
  explicit ObservationReader(const std::filesystem::path& file) : lines_(file) {}

  record::ObservationRecording read() {
    recording_.source = lines_.name();
    read_header();
    while (read_epoch()) {
    }
    if (recording_.epochs.empty())
      lines_.refuse("no epoch with observations", "at least one", "The header is whole, but nothing follows it.");
    std::ranges::stable_sort(recording_.marks, {}, &record::TimeMark::t);
    report();
    return std::move(recording_);
  }

 private:
  void read_header();
  void read_header_line(std::string_view line, std::string_view label);
  void read_slots(std::string_view line);

  [[nodiscard]] bool read_epoch();
  [[nodiscard]] std::optional<geo::Calendar> calendar_of(std::string_view line) const;
  [[nodiscard]] bool satellites_of_epoch(std::string_view line, std::size_t satellites, std::vector<std::string>& ids);
  [[nodiscard]] bool read_records2(const std::vector<std::string>& ids, bool power_failure);
  [[nodiscard]] bool read_records3(std::size_t satellites, bool power_failure);
  [[nodiscard]] bool skip_event(char flag, std::size_t lines);
  void keep_mark(std::string_view line);
  void begin_satellite(std::optional<Satellite> satellite);
  void take(std::string_view line, std::size_t at, std::size_t column);
  void end_satellite(bool power_failure);
  void keep_epoch();
  void report();

  RinexLines lines_;
  record::ObservationRecording recording_;
  int major_ = 0;
  char system_ = ' ';  ///< of the whole file, 'M' for several
  RinexTime scale_ = RinexTime::kGps;
  RinexColumns columns_{lines_};

  record::ObservationEpoch epoch_;
  std::optional<Satellite> satellite_;
  std::vector<Observation> row_;
  Counted spoiled_, impossible_, repeated_satellites_, unknown_satellites_, repeated_, reversed_, cut_off_, slips_, events_,
      failures_;
};

void ObservationReader::read_header() {
  const RinexKind kind = read_kind(lines_);
  if (kind.type != 'O')
    lines_.refuse(fmt::format("a file of type {}", kind.stated), "observations", "Navigation files belong under `nav`.");
  major_ = kind.major;
  system_ = kind.system;
  std::string_view line;
  while (lines_.next(line)) {
    const std::string_view label = label_of(line);
    if (label == "END OF HEADER") {
      columns_.check();
      return;
    }
    read_header_line(line, label);
  }
  lines_.refuse("the end of the file", "END OF HEADER", "The header is cut off.");
}

void ObservationReader::read_header_line(std::string_view line, std::string_view label) {
  const auto vector_of = [&](std::size_t width) -> std::optional<Eigen::Vector3d> {
    const auto x = number_field(line, 0, width), y = number_field(line, width, width), z = number_field(line, 2 * width, width);
    if (!x || !y || !z) return std::nullopt;
    return Eigen::Vector3d(*x, *y, *z);
  };
  constexpr std::size_t kVector = 14;
  if (label == "MARKER NAME") recording_.marker = trimmed(field(line, 0, 60));
  if (label == "REC # / TYPE / VERS") recording_.receiver = trimmed(field(line, 20, 20));
  if (label == "ANT # / TYPE") recording_.antenna = trimmed(field(line, 20, 20));
  if (label == "APPROX POSITION XYZ") {
    recording_.approximate_r_e = vector_of(kVector);
    // Receivers write zeros for unknown values.
    constexpr double kLeast = 6e6;  // m
    if (recording_.approximate_r_e && recording_.approximate_r_e->norm() < kLeast) recording_.approximate_r_e.reset();
  }
  if (label == "ANTENNA: DELTA H/E/N")
    if (const auto delta = vector_of(kVector)) recording_.antenna_offset_enu = {(*delta)(1), (*delta)(2), (*delta)(0)};
  columns_.read(line, label, major_);
  if (label == "GLONASS SLOT / FRQ #") read_slots(line);
  if (label == "TIME OF FIRST OBS") {
    const std::string_view scale = trimmed(field(line, 48, 3));
    if (scale == "GLO" || (scale.empty() && system_ == 'R')) scale_ = RinexTime::kUtc;
    if (scale == "BDT" || (scale.empty() && system_ == 'C')) scale_ = RinexTime::kBeidou;
  }
}

void ObservationReader::read_slots(std::string_view line) {
  constexpr std::size_t kFirst = 4, kStep = 7, kPerLine = 8;
  for (std::size_t i = 0; i < kPerLine; ++i) {
    const auto satellite = satellite_field(field(line, kFirst + kStep * i, 3), 'R');
    const auto channel = integer_field(line, kFirst + kStep * i + 3, 3);
    if (satellite && channel) recording_.glonass_channels[satellite->number] = *channel;
  }
}

std::optional<geo::Calendar> ObservationReader::calendar_of(std::string_view line) const {
  const bool two = major_ == 2;
  const auto year = integer_field(line, two ? 0 : 2, two ? 3 : 4);
  const std::size_t at = two ? 3 : 6;
  std::array<std::optional<int>, 4> rest;  // month, day, hour, minute
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = integer_field(line, at + 3 * i, 3);
  const auto second = number_field(line, at + 12, 11);
  if (!year || !second || std::ranges::any_of(rest, [](const auto& v) { return !v; })) return std::nullopt;
  return geo::Calendar{full_year(*year), *rest[0], *rest[1], *rest[2], *rest[3], *second};
}

bool ObservationReader::read_epoch() {
  std::string_view line;
  do {
    if (!lines_.next(line)) return false;
  } while (trimmed(line).empty());
  const bool two = major_ == 2;
  if (!two && line[0] != '>') lines_.refuse(in_quotes(line), "an epoch line, which begins with '>'");
  const std::size_t flag_at = two ? 28 : 31;
  const char flag = line.size() > flag_at && line[flag_at] != ' ' ? line[flag_at] : '0';
  const auto satellites = integer_field(line, flag_at + 1, 3);
  if (!satellites || *satellites < 0 || flag < '0' || flag > '6')
    lines_.refuse(in_quotes(line, 60), "an epoch line with its flag and the number of satellites");
  const auto number = static_cast<std::size_t>(*satellites);
  if (flag == '5') keep_mark(line);
  if (flag > '1') return skip_event(flag, number);
  const auto calendar = calendar_of(line);
  const auto t = calendar ? gps_time(*calendar, scale_) : std::nullopt;
  if (!t) lines_.refuse(in_quotes(line, 29), "a date and a time");
  epoch_ = {*t, {}};
  if (flag == '1') failures_.add(*t);
  std::vector<std::string> ids;
  const bool whole =
      two ? satellites_of_epoch(line, number, ids) && read_records2(ids, flag == '1') : read_records3(number, flag == '1');
  if (!whole) {
    cut_off_.add(*t);
    return false;
  }
  keep_epoch();
  return true;
}

bool ObservationReader::satellites_of_epoch(std::string_view line, std::size_t satellites, std::vector<std::string>& ids) {
  constexpr std::size_t kFirst = 32, kPerLine = 12;
  for (std::size_t i = 0; i < satellites; ++i) {
    if (i > 0 && i % kPerLine == 0 && !lines_.next(line)) return false;
    ids.emplace_back(field(line, kFirst + 3 * (i % kPerLine), 3));
  }
  return true;
}

bool ObservationReader::read_records2(const std::vector<std::string>& ids, bool power_failure) {
  constexpr std::size_t kPerLine = 5;
  std::string_view line;
  for (const std::string& id : ids) {
    begin_satellite(satellite_field(id, system_ == 'M' ? 'G' : system_));
    for (std::size_t i = 0; i < columns_.of_rinex2(); ++i) {
      if (i % kPerLine == 0 && !lines_.next(line)) return false;
      take(line, kObservationWidth * (i % kPerLine), i);
    }
    end_satellite(power_failure);
  }
  return true;
}

bool ObservationReader::read_records3(std::size_t satellites, bool power_failure) {
  std::string_view line;
  for (std::size_t s = 0; s < satellites; ++s) {
    if (!lines_.next(line)) return false;
    if (!line.empty() && line[0] == '>') {  // fewer satellites than announced
      lines_.put_back();
      spoiled_.add(epoch_.t);
      return true;
    }
    begin_satellite(satellite_field(field(line, 0, 3), system_));
    if (satellite_) {
      const std::size_t columns = columns_.of(satellite_->system).columns.size();
      for (std::size_t i = 0; i < columns; ++i) take(line, 3 + kObservationWidth * i, i);
    }
    end_satellite(power_failure);
  }
  return true;
}

/// Flag 5: an outside event, whose time is in the scale of the observations. Several may stand between two epochs.
void ObservationReader::keep_mark(std::string_view line) {
  const auto calendar = calendar_of(line);
  const auto t = calendar ? gps_time(*calendar, scale_) : std::nullopt;
  if (!t) return spoiled_.add();
  recording_.marks.emplace_back().t = *t;
}

/// Flags 2 to 5 announce header lines, 6 cycle slips in the form of observations.
bool ObservationReader::skip_event(char flag, std::size_t lines) {
  (flag == '6' ? slips_ : events_).add();
  constexpr std::size_t kPerLine = 5;
  if (flag == '6' && major_ == 2) lines *= (columns_.of_rinex2() + kPerLine - 1) / kPerLine;
  std::string_view line;
  for (std::size_t i = 0; i < lines; ++i) {
    if (!lines_.next(line)) {
      cut_off_.add();
      return false;
    }
    if (flag != '6') read_header_line(line, label_of(line));
  }
  return true;
}

void ObservationReader::begin_satellite(std::optional<Satellite> satellite) {
  satellite_ = satellite;
  row_.clear();
  if (!satellite) return unknown_satellites_.add(epoch_.t);
  for (const Signal signal : columns_.of(satellite->system).signals) {
    Observation& observation = row_.emplace_back();
    observation.satellite = *satellite;
    observation.signal = signal;
  }
}

void ObservationReader::take(std::string_view line, std::size_t at, std::size_t column) {
  constexpr std::size_t kNumber = 14;
  if (!satellite_) return;
  const ObservationType type = columns_.of(satellite_->system).columns[column];
  if (type.quantity == ' ' || trimmed(field(line, at, kNumber)).empty()) return;
  auto value = number_field(line, at, kNumber);
  if (!value) return spoiled_.add(epoch_.t);
  *value /= type.factor;
  if (*value == 0.0) return;
  const double largest = type.quantity == 'C' ? 1e9 : type.quantity == 'L' ? 1e11 : type.quantity == 'D' ? 1e6 : 1e3;
  if (std::abs(*value) > largest || (type.quantity == 'C' && *value < 0.0)) return impossible_.add(epoch_.t);
  Observation& observation = row_[type.slot];
  switch (type.quantity) {
    case 'C':
      observation.code_m = *value;
      break;
    case 'D':
      observation.doppler_hz = *value;
      break;
    case 'S':
      observation.cn0_dbhz = *value;
      break;
    default: {
      observation.phase_cycles = *value;
      const std::string_view flag = field(line, at + kNumber, 1);
      const int bits = !flag.empty() && flag[0] >= '0' && flag[0] <= '9' ? flag[0] - '0' : 0;
      observation.lost_lock = (bits & 1) != 0;
      observation.half_cycle = (bits & 2) != 0;
    }
  }
}

void ObservationReader::end_satellite(bool power_failure) {
  if (!satellite_) return;
  const auto same = [&](const Observation& o) { return o.satellite == *satellite_; };
  if (std::ranges::any_of(epoch_.observations, same)) return repeated_satellites_.add(epoch_.t);
  for (Observation& observation : row_) {
    if (!observation.code_m && !observation.phase_cycles && !observation.doppler_hz) continue;
    observation.lost_lock = observation.lost_lock || power_failure;
    epoch_.observations.push_back(observation);
  }
}

void ObservationReader::keep_epoch() {
  if (epoch_.observations.empty()) return;
  auto& epochs = recording_.epochs;
  if (!epochs.empty() && epoch_.t == epochs.back().t) return repeated_.add(epoch_.t);
  if (!epochs.empty() && epoch_.t < epochs.back().t) return reversed_.add(epoch_.t);
  std::ranges::stable_sort(epoch_.observations, {}, [](const Observation& o) { return std::pair(o.satellite, o.signal); });
  epochs.push_back(std::move(epoch_));
}

void ObservationReader::report() {
  recording_.events = lines_.events();
  const CountedEvents add(recording_.events, recording_.source);
  add(spoiled_, "rinex_spoiled", "number or record", "numbers or records", "that cannot be read left out");
  add(impossible_, "rinex_impossible", "number", "numbers", "that no receiver measures left out");
  add(unknown_satellites_, "rinex_unknown_satellite", "record", "records", "of no known satellite left out");
  add(repeated_satellites_, "rinex_repeated_satellite", "record", "records",
      "of a satellite that the epoch has already left out");
  add(repeated_, "rinex_repeated_epoch", "epoch", "epochs", "with the time of the one before left out");
  add(reversed_, "rinex_reversed_epoch", "epoch", "epochs", "earlier than the one before left out");
  add(cut_off_, "rinex_cut_off", "epoch", "epochs", "that the end of the file cuts off left out");
  add(failures_, "rinex_power_failure", "power failure", "power failures", "of the receiver: all signals lost lock",
      record::Event::Severity::kInfo);
  add(slips_, "rinex_slip_records", "record", "records", "of cycle slips not used", record::Event::Severity::kInfo);
  add(events_, "rinex_event", "event", "events", "of the receiver or the operator", record::Event::Severity::kInfo);
}

}  // namespace

record::ObservationRecording read_observations(const std::filesystem::path& file, std::optional<geo::GpsTime> near) {
  if (const Format* format = format_beside_rinex(file, &Format::read_observations))
    return format->read_observations_near ? format->read_observations_near(file, near) : format->read_observations(file);
  return read_as(file, FileKind::Content::kRinex, "RINEX observations", [&] { return ObservationReader(file).read(); });
}

}  // namespace coast::io
