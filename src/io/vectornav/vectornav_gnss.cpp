// Positions of a VectorNav's GNSS receiver (VectorNav ICD for VN-310: GNSS groups); of the second one where the file has no
// first.

#include <fmt/format.h>

#include <cmath>

#include "../repairs.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "vectornav_readers.hpp"
#include "vectornav_stream.hpp"
#include "vectornav_values.hpp"

namespace coast::io {

namespace {

/// GnssFix: 0 none, 1 time, 2 2-D, 3 3-D, 4 SBAS, 7 RTK float, 8 RTK fixed.
std::optional<record::FixQuality> vectornav_quality(std::uint8_t fix) {
  switch (fix) {
    case 3:
      return record::FixQuality::kSingle;
    case 4:
      return record::FixQuality::kSbas;
    case 7:
      return record::FixQuality::kFloat;
    case 8:
      return record::FixQuality::kFixed;
    default:
      return std::nullopt;
  }
}

/// Position of the fields PosLla, else PosEcef.
std::optional<Eigen::Vector3d> vectornav_position(const VectorNavMessage& message, VectorNavGroup group) {
  constexpr double kHighestFix = 1e6, kNearest = 5e6, kFarthest = 8e6;  // m
  if (const auto lla = message.field(group, 5)) {
    const Eigen::Vector3d p = vector_at<double>(*lla);
    if (!(std::abs(p.x()) <= 90.0 && std::abs(p.y()) <= 360.0 && std::abs(p.z()) < kHighestFix)) return std::nullopt;
    return geo::ecef_from_geodetic({p.x() * geo::kDegree, p.y() * geo::kDegree, p.z()});
  }
  if (const auto ecef = message.field(group, 6)) {
    const Eigen::Vector3d r = vector_at<double>(*ecef);
    if (r.norm() > kNearest && r.norm() < kFarthest) return r;
  }
  return std::nullopt;
}

class VectorNavGnssReader {
 public:
  explicit VectorNavGnssReader(const GnssFileOptions& options)
      : options_(options), stream_(options.file), order_(error_, repairs_) {}

  record::GnssRecording read() {
    recording_.source = stream_.name();
    VectorNavMessage message;
    while (stream_.next(message)) take(message);
    recording_.events = vectornav_file_events(stream_.census(), recording_.source);
    if (recording_.fixes.empty()) refuse();
    repairs_.finish(rows_, recording_.events);
    report();
    return std::move(recording_);
  }

 private:
  void take(const VectorNavMessage& message);
  void take_fix(const VectorNavMessage& message, geo::GpsTime t);
  [[nodiscard]] std::optional<Eigen::Vector3d> position_sd(const VectorNavMessage& message) const;
  void add_velocity(const VectorNavMessage& message, record::GnssFix& fix) const;
  [[noreturn]] void refuse() const;
  void report();

  const GnssFileOptions& options_;
  VectorNavStream stream_;
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({stream_.name(), 0, fmt::format("position {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  record::GnssRecording recording_;
  std::optional<VectorNavGroup> group_;  ///< the receiver
  std::optional<geo::GpsTime> last_;     ///< of the last message: the sensor repeats a position until the next one
  long rows_ = 0, without_ = 0, no_accuracy_ = 0, no_time_ = 0;
};

void VectorNavGnssReader::take(const VectorNavMessage& message) {
  using enum VectorNavGroup;
  for (const VectorNavGroup group : {kGnss1, kGnss2})
    if (!group_ && (message.field(group, 5) || message.field(group, 6))) group_ = group;
  if (!group_ || (!message.field(*group_, 5) && !message.field(*group_, 6))) return;
  const auto tow = message.field(*group_, 1), week = message.field(*group_, 2);
  const auto t =
      tow && week ? week_and_nanoseconds(number_at<std::uint16_t>(*week, 0), number_at<std::uint64_t>(*tow, 0)) : std::nullopt;
  if (t && t == last_) return;
  last_ = t;
  ++rows_;
  if (t)
    take_fix(message, *t);
  else
    ++no_time_;
}

void VectorNavGnssReader::take_fix(const VectorNavMessage& message, geo::GpsTime t) {
  const auto fix_field = message.field(*group_, 4);
  const auto quality = fix_field ? vectornav_quality(number_at<std::uint8_t>(*fix_field, 0)) : record::FixQuality::kUnknown;
  const auto r_e = vectornav_position(message, *group_);
  if (!quality || !r_e) {
    ++without_;
    return;
  }
  const auto sd = position_sd(message);
  if (!sd) {
    ++no_accuracy_;
    return;
  }
  record::GnssFix fix;
  fix.t = t + options_.time.offset_s;
  fix.r_ea_e = *r_e;
  fix.position_cov_n = sd->cwiseAbs2().asDiagonal();
  fix.quality = *quality;
  if (const auto satellites = message.field(*group_, 3)) fix.satellites = number_at<std::uint8_t>(*satellites, 0);
  add_velocity(message, fix);
  auto& fixes = recording_.fixes;
  if (order_.accept(fix.t, !fixes.empty() && fixes.back().r_ea_e == fix.r_ea_e)) fixes.push_back(fix);
}

std::optional<Eigen::Vector3d> VectorNavGnssReader::position_sd(const VectorNavMessage& message) const {
  constexpr double kLargest = 1e6;  // m
  if (options_.sd) return options_.sd;
  const auto field = message.field(*group_, 9);
  if (!field) return std::nullopt;
  const Eigen::Vector3d sd = vector_at<float>(*field);  // N, E, D
  if (!(sd.minCoeff() > 0.0 && sd.maxCoeff() < kLargest) || !sd.allFinite()) return std::nullopt;
  return sd;
}

/// VelU is of the three components together.
void VectorNavGnssReader::add_velocity(const VectorNavMessage& message, record::GnssFix& fix) const {
  constexpr double kFastest = 1e4, kLargest = 1e3;  // m/s
  const auto velocity = message.field(*group_, 7), sd = message.field(*group_, 10);
  if (!velocity || (!sd && !options_.velocity_sd)) return;
  const Eigen::Vector3d v = vector_at<float>(*velocity);
  if (!(v.norm() < kFastest)) return;
  if (options_.velocity_sd) {
    fix.velocity = {v, options_.velocity_sd->cwiseAbs2().asDiagonal()};
    return;
  }
  const auto speed_sd = static_cast<double>(number_at<float>(*sd, 0));
  if (speed_sd > 0.0 && speed_sd < kLargest) fix.velocity = {v, speed_sd * speed_sd / 3.0 * Eigen::Matrix3d::Identity()};
}

void VectorNavGnssReader::refuse() const {
  if (rows_ == 0)
    throw InputError(
        {stream_.name(), 0, "VectorNav messages without a position of GNSS", "PosLla or PosEcef of a GNSS group", ""});
  throw InputError(
      {stream_.name(), 0,
       fmt::format("{} positions, but no GNSS fix: {} without a solution, {} without Tow and Week of the GNSS group, "
                   "{} without PosU",
                   rows_, without_, no_time_, no_accuracy_),
       "at least one fix", no_accuracy_ > 0 ? "Add PosU to the output, or give `sd_m: [n, e, d]` beside the file." : ""});
}

void VectorNavGnssReader::report() {
  const auto add = [&](long number, const char* kind, const char* text, record::Event::Severity severity) {
    if (number > 0)
      recording_.events.push_back(
          {severity, kind, fmt::format("{}: {} {}", recording_.source, number, text), std::nullopt, number});
  };
  using enum record::Event::Severity;
  add(without_, "no_solution", "epochs without a three-dimensional solution left out", kInfo);
  add(no_time_, "fix_no_time", "positions without the time of the GNSS group left out", kWarning);
  add(no_accuracy_, "fix_no_accuracy", "positions without accuracy left out", kWarning);
}

}  // namespace

record::GnssRecording read_vectornav_gnss(const GnssFileOptions& options, Format::Near) {
  return VectorNavGnssReader(options).read();
}

}  // namespace coast::io
