// Positions of BESTGNSSPOS and its like, with the velocity of the same epoch (OEM7 Commands and Logs Reference Manual). A file
// often has several of these logs: one of them is read, those of GNSS alone before those that a SPAN receiver computes with its
// IMU.

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "../receiver_positions.hpp"
#include "coast/geo/units.hpp"
#include "novatel_log.hpp"
#include "novatel_positions.hpp"
#include "novatel_readers.hpp"

namespace coast::io {

namespace {

using record::FixQuality;

/// A log of positions with that of its velocities, the first the most wanted.
struct PositionLog {
  std::uint32_t position, velocity;
};
constexpr std::array<PositionLog, 6> kPositionLogs = {{{novatel::kBestGnssPos, novatel::kBestGnssVel},
                                                       {novatel::kBestGpsPos, novatel::kBestGpsVel},
                                                       {novatel::kBestPos, novatel::kBestVel},
                                                       {novatel::kRtkPos, novatel::kRtkVel},
                                                       {novatel::kPppPos, novatel::kPppVel},
                                                       {novatel::kPsrPos, novatel::kPsrVel}}};

/// None for types that are no measurement: none at all, entered by hand, or predicted.
std::optional<FixQuality> novatel_quality(std::uint32_t type) {
  switch (type) {
    case 16:
    case 53:
      return FixQuality::kSingle;
    case 17:
    case 20:
    case 54:
    case 57:
    case 66:
      return FixQuality::kDgps;
    case 18:
    case 52:
      return FixQuality::kSbas;
    case 32:
    case 33:
    case 34:
    case 55:
      return FixQuality::kFloat;
    case 48:
    case 49:
    case 50:
    case 51:
    case 56:
      return FixQuality::kFixed;
    case 58:
    case 59:
    case 64:
    case 65:
    case 68:
    case 69:
    case 73:
    case 74:
    case 77:
    case 78:
    case 79:
    case 80:
      return FixQuality::kPpp;
    case 67:
    case 70:
    case 71:
    case 72:
      return FixQuality::kUnknown;
    default:
      return std::nullopt;
  }
}

bool is_with_imu(std::uint32_t type) {
  return (type >= 51 && type <= 59) || type == 73 || type == 74 || type == 79 || type == 80;
}

struct NovAtelPosition {
  ReceiverPosition position;
  bool with_imu = false;
  bool other_datum = false;
};

std::optional<Eigen::Matrix3d> covariance_of(double north, double east, double up) {
  constexpr double kLargest = 1e6;  // m
  for (const double sd : {north, east, up})
    if (!(sd > 0.0 && sd < kLargest)) return std::nullopt;
  return Eigen::Matrix3d(Eigen::Vector3d(north, east, up).cwiseAbs2().asDiagonal());
}

/// BESTPOS. Its height is above mean sea level, with the undulation beside it.
std::optional<NovAtelPosition> position_of(const NovAtelLog& log) {
  constexpr std::uint32_t kWgs84 = 61;
  constexpr std::array<NovAtelWord, 2> kDatums = {{{"WGS84", kWgs84}, {"WGS84-ALT", kWgs84}}};
  NovAtelFields f = log.fields();
  const std::uint32_t status = f.word(kSolutionStatus), type = f.word(kPositionType);
  const double latitude = geo::kDegree * f.f64(), longitude = geo::kDegree * f.f64();
  const double above_sea = f.f64(), undulation = f.f32();
  const std::uint32_t datum = f.word(kDatums);
  const double sd_north = f.f32(), sd_east = f.f32(), sd_up = f.f32();
  f.skip_text(4);  // reference station
  static_cast<void>(f.f32());
  static_cast<void>(f.f32());  // ages
  static_cast<void>(f.u8());   // satellites tracked
  const int satellites = f.u8();
  if (!f.good()) return std::nullopt;
  NovAtelPosition p;
  const auto quality = novatel_quality(type);
  p.position.t = log.time();
  p.position.solved = status == 0 && quality.has_value();
  p.position.r_ea_e = ecef_if_on_earth({latitude, longitude, above_sea + undulation});
  p.position.position_cov_n = covariance_of(sd_north, sd_east, sd_up);
  p.position.quality = quality.value_or(FixQuality::kUnknown);
  p.position.satellites = satellites;
  p.with_imu = is_with_imu(type);
  p.other_datum = datum != kWgs84;
  return p;
}

struct NovAtelVelocity {
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();
  double latency_s = 0.0;
};

/// BESTVEL. It states no accuracy.
std::optional<NovAtelVelocity> velocity_of(const NovAtelLog& log) {
  NovAtelFields f = log.fields();
  const std::uint32_t status = f.word(kSolutionStatus), type = f.word(kPositionType);
  NovAtelVelocity v;
  v.latency_s = f.f32();
  static_cast<void>(f.f32());  // age
  const double horizontal = f.f64(), course = geo::kDegree * f.f64(), up = f.f64();
  if (!f.good() || status != 0 || type == 0) return std::nullopt;
  v.v_n = {horizontal * std::cos(course), horizontal * std::sin(course), -up};
  if (!v.v_n.allFinite()) return std::nullopt;
  return v;
}

class NovAtelGnssReader {
 public:
  explicit NovAtelGnssReader(const GnssFileOptions& options) : stream_(options.file), positions_(options, stream_.name()) {}

  record::GnssRecording read() {
    NovAtelLog log;
    while (stream_.next(log)) take(log);
    const PositionLog* chosen = choose();
    if (chosen != nullptr) give(*chosen);
    record::GnssRecording recording = positions_.finish(
        stream_.events(),
        {.positions = {stream_.name(), 0, "NovAtel logs without BESTGNSSPOS, BESTPOS, RTKPOS, PPPPOS and PSRPOS", "positions",
                       "If it holds RANGE or RANGECMP, `gnss: {ppk: {rover: .., base: .., nav: [..]}}` computes them."},
         .for_time = "The receiver did not know GPS time finely.",
         .for_accuracy = "Give `sd_m: [n, e, d]` beside the file."});
    if (chosen != nullptr) report(*chosen, recording);
    return recording;
  }

 private:
  void take(const NovAtelLog& log);
  [[nodiscard]] const PositionLog* choose() const;
  void give(const PositionLog& chosen);
  void report(const PositionLog& chosen, record::GnssRecording& recording) const;

  NovAtelStream stream_;
  ReceiverPositions positions_;
  std::map<std::uint32_t, std::vector<NovAtelPosition>> found_;                  ///< by log
  std::map<std::uint32_t, std::map<std::int64_t, NovAtelVelocity>> velocities_;  ///< by log and millisecond
  Counted spoiled_, with_imu_, other_datum_, late_velocity_;
};

std::int64_t millisecond_of(geo::GpsTime t) {
  constexpr std::int64_t kNanoseconds = 1'000'000;
  return (t.nanoseconds() + kNanoseconds / 2) / kNanoseconds;
}

void NovAtelGnssReader::take(const NovAtelLog& log) {
  if (log.second_antenna) return;
  for (const PositionLog& one : kPositionLogs) {
    if (log.id == one.position) {
      if (const auto position = position_of(log))
        found_[log.id].push_back(*position);
      else
        spoiled_.add(log.time());
    }
    const auto t = log.id == one.velocity ? log.time() : std::nullopt;
    const auto velocity = t ? velocity_of(log) : std::nullopt;
    if (velocity) velocities_[log.id][millisecond_of(*t)] = *velocity;
  }
}

const PositionLog* NovAtelGnssReader::choose() const {
  const PositionLog* any = nullptr;
  for (const PositionLog& one : kPositionLogs) {
    const auto found = found_.find(one.position);
    if (found == found_.end()) continue;
    if (any == nullptr) any = &one;
    for (const NovAtelPosition& p : found->second)
      if (p.position.solved && p.position.t) return &one;
  }
  return any;
}

void NovAtelGnssReader::give(const PositionLog& chosen) {
  constexpr double kLatest = 0.05;  // s: beyond, the velocity is a mean over the time before
  const auto& velocities = velocities_[chosen.velocity];
  for (NovAtelPosition& p : found_[chosen.position]) {
    const auto velocity = p.position.t ? velocities.find(millisecond_of(*p.position.t)) : velocities.end();
    if (velocity != velocities.end()) {
      if (velocity->second.latency_s <= kLatest)
        p.position.v_ea_n = velocity->second.v_n;
      else
        late_velocity_.add(p.position.t);
    }
    if (!positions_.take(p.position)) continue;
    if (p.with_imu) with_imu_.add(p.position.t);
    if (p.other_datum) other_datum_.add(p.position.t);
  }
}

void NovAtelGnssReader::report(const PositionLog& chosen, record::GnssRecording& recording) const {
  using enum record::Event::Severity;
  const auto add = [&](const Counted& counted, const char* kind, const char* what, record::Event::Severity severity) {
    add_counted(recording.events, recording.source, counted, {kind, "position is", "positions are", what, severity});
  };
  add(with_imu_, "fix_with_imu",
      "of GNSS and the receiver's own IMU together: their errors are correlated over time, and in gaps of GNSS they are no "
      "measurements. Log BESTGNSSPOS instead",
      kWarning);
  add(other_datum_, "fix_datum", "on another datum than WGS84, and are taken as they are", kWarning);
  add(spoiled_, "fix_spoiled", "not of the form of its log and left out", kWarning);
  add(late_velocity_, "fix_velocity_latency", "without their velocity, whose time is more than 0.05 s before", kInfo);
  std::string others;
  for (const auto& [id, found] : found_)
    if (id != chosen.position) others += fmt::format("{}{} {}", others.empty() ? "" : ", ", found.size(), novatel_log_name(id));
  if (!others.empty())
    recording.events.push_back({kInfo, "fix_other_logs",
                                fmt::format("{}: the positions are those of {}; beside it the file has {}", recording.source,
                                            novatel_log_name(chosen.position), others),
                                std::nullopt, 1});
}

}  // namespace

record::GnssRecording read_novatel_gnss(const GnssFileOptions& options, Format::Near) {
  return NovAtelGnssReader(options).read();
}

}  // namespace coast::io
