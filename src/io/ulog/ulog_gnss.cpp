// Positions of flight logs: vehicle_gps_position and sensor_gps (PX4 user guide, uORB message reference; the names of the
// fields changed with version 1.14).

#include "ulog_gnss.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "../repairs.hpp"
#include "coast/geo/units.hpp"
#include "ulog_readers.hpp"

namespace coast::io {

namespace {

/// Numbers of a message by name.
class UlogRow {
 public:
  explicit UlogRow(const UlogData& data) : data_(data) {}
  [[nodiscard]] std::optional<double> number(std::string_view name) const {
    const auto field = data_.topic->layout.find(name);
    const auto value = field ? ulog_number(data_.bytes, *field) : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
  }
  [[nodiscard]] std::optional<std::int64_t> integer(std::string_view name) const {
    const auto field = data_.topic->layout.find(name);
    return field ? ulog_integer(data_.bytes, *field) : std::nullopt;
  }
  /// In degrees or m: by its new name, or by its old one in an integer unit.
  [[nodiscard]] std::optional<double> renamed(std::string_view name, std::string_view before, double unit) const {
    if (const auto value = number(name)) return value;
    const auto value = number(before);
    return value ? std::optional(unit * *value) : std::nullopt;
  }

 private:
  const UlogData& data_;
};

std::optional<geo::GpsTime> from_utc_microseconds(std::int64_t us) {
  constexpr std::int64_t kMicro = 1'000'000;
  constexpr std::int64_t kFirst = 946'684'800, kLast = 4'102'444'800;  // s: years 2000 to 2100
  const std::int64_t seconds = us / kMicro;
  if (seconds < kFirst || seconds > kLast) return std::nullopt;
  // In two parts: a double of POSIX time has no digits for microseconds.
  return geo::GpsTime::from_unix_utc(static_cast<double>(seconds)) + 1e-6 * static_cast<double>(us % kMicro);
}

std::optional<UlogPosition> position_of(const UlogRow& row) {
  const auto boot = row.integer("timestamp");
  const auto latitude = row.renamed("latitude_deg", "lat", 1e-7), longitude = row.renamed("longitude_deg", "lon", 1e-7);
  const auto height = row.renamed("altitude_ellipsoid_m", "alt_ellipsoid", 1e-3);
  if (!boot || *boot < 0 || *boot > kLongestUlogUptime || !latitude || !longitude || !height) return std::nullopt;
  UlogPosition p;
  constexpr std::int64_t kLargestDelay = 10'000'000;  // us; beyond, the field is not set
  const std::int64_t relative = row.integer("timestamp_time_relative").value_or(0);
  p.boot_us = *boot + (std::abs(relative) < kLargestDelay ? relative : 0);
  p.t = from_utc_microseconds(row.integer("time_utc_usec").value_or(0));
  p.fix_type = static_cast<int>(row.integer("fix_type").value_or(0));
  p.place = {*latitude * geo::kDegree, *longitude * geo::kDegree, *height};
  p.horizontal_sd = row.number("eph").value_or(0.0);
  p.vertical_sd = row.number("epv").value_or(0.0);
  p.satellites = static_cast<int>(row.integer("satellites_used").value_or(0));
  const auto north = row.number("vel_n_m_s"), east = row.number("vel_e_m_s"), down = row.number("vel_d_m_s");
  if (!north || !east || !down || row.number("vel_ned_valid").value_or(1.0) == 0.0) return p;
  p.velocity_n = {*north, *east, *down};
  p.speed_sd = row.number("s_variance_m_s").value_or(0.0);  // a standard deviation by its unit and its use
  return p;
}

/// fix_type: 3 3-D, 4 code differential, 5 RTK float, 6 RTK fixed; below 3 none; 8 extrapolated.
std::optional<record::FixQuality> ulog_quality(int fix_type) {
  switch (fix_type) {
    case 3:
      return record::FixQuality::kSingle;
    case 4:
      return record::FixQuality::kDgps;
    case 5:
      return record::FixQuality::kFloat;
    case 6:
      return record::FixQuality::kFixed;
    default:
      return std::nullopt;
  }
}

class UlogFixes {
 public:
  UlogFixes(const GnssFileOptions& options, const std::string& source)
      : options_(options), source_(source), order_(error_, repairs_) {}

  void take(const UlogPosition& p) {
    constexpr double kLargestSd = 1e6, kHighestFix = 1e6;  // m
    ++rows_;
    const auto quality = ulog_quality(p.fix_type);
    if (!quality) return count(without_);
    if (!p.t) return count(no_time_);
    const bool accuracy =
        p.horizontal_sd > 0.0 && p.horizontal_sd < kLargestSd && p.vertical_sd > 0.0 && p.vertical_sd < kLargestSd;
    const bool on_earth = std::abs(p.place.latitude) <= 0.5 * geo::kPi && std::abs(p.place.longitude) <= 2.0 * geo::kPi &&
                          std::abs(p.place.height) < kHighestFix;
    if (!on_earth || (!accuracy && !options_.sd)) return count(no_accuracy_);
    record::GnssFix fix;
    fix.t = *p.t + options_.time.offset_s;
    fix.r_ea_e = geo::ecef_from_geodetic(p.place);
    const double horizontal = p.horizontal_sd / std::sqrt(2.0);
    const Eigen::Vector3d sd = options_.sd.value_or(Eigen::Vector3d(horizontal, horizontal, p.vertical_sd));
    fix.position_cov_n = sd.cwiseAbs2().asDiagonal();
    fix.quality = *quality;
    fix.satellites = p.satellites;
    add_velocity(p, fix);
    auto& fixes = recording_.fixes;
    if (order_.accept(fix.t, !fixes.empty() && fixes.back().r_ea_e == fix.r_ea_e)) fixes.push_back(fix);
  }

  record::GnssRecording finish(record::Events events) {
    if (recording_.fixes.empty()) refuse();
    recording_.source = source_;
    recording_.events = std::move(events);
    repairs_.finish(rows_, recording_.events);
    const auto add = [&](long number, const char* kind, const char* text, record::Event::Severity severity) {
      if (number > 0)
        recording_.events.push_back({severity, kind, fmt::format("{}: {} {}", source_, number, text), std::nullopt, number});
    };
    using enum record::Event::Severity;
    add(without_, "no_solution", "epochs without a three-dimensional solution left out", kInfo);
    add(no_time_, "fix_no_time", "positions before the receiver knew UTC left out", kInfo);
    add(no_accuracy_, "fix_no_accuracy", "positions without accuracy, or not on the Earth, left out", kWarning);
    return std::move(recording_);
  }

 private:
  static void count(long& what) { ++what; }
  void add_velocity(const UlogPosition& p, record::GnssFix& fix) const {
    constexpr double kFastest = 1e4, kLargestSd = 1e3;  // m/s
    if (!(p.velocity_n.norm() < kFastest)) return;
    if (options_.velocity_sd)
      fix.velocity = {p.velocity_n, options_.velocity_sd->cwiseAbs2().asDiagonal()};
    else if (p.speed_sd > 0.0 && p.speed_sd < kLargestSd)
      fix.velocity = {p.velocity_n, p.speed_sd * p.speed_sd / 3.0 * Eigen::Matrix3d::Identity()};
  }
  [[noreturn]] void refuse() const {
    if (rows_ == 0) throw InputError({source_, 0, "a flight log without positions", "vehicle_gps_position or sensor_gps", ""});
    throw InputError({source_, 0,
                      fmt::format("{} positions, but no GNSS fix: {} without a three-dimensional solution, {} without UTC, {} "
                                  "without accuracy",
                                  rows_, without_, no_time_, no_accuracy_),
                      "at least one fix", ""});
  }

  const GnssFileOptions& options_;
  const std::string& source_;
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({source_, 0, fmt::format("position {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  record::GnssRecording recording_;
  long rows_ = 0, without_ = 0, no_time_ = 0, no_accuracy_ = 0;
};

}  // namespace

void UlogPositions::take(const UlogData& data) {
  const bool of_sensor = data.topic->name == "sensor_gps";
  if (!of_sensor && data.topic->name != "vehicle_gps_position") return;
  if (const auto p = position_of(UlogRow(data))) receivers_[{of_sensor, data.topic->instance}].push_back(*p);
}

const std::vector<UlogPosition>& UlogPositions::best() const {
  static const std::vector<UlogPosition> none;
  return receivers_.empty() ? none : receivers_.begin()->second;
}

record::GnssRecording read_ulog_gnss(const GnssFileOptions& options, Format::Near) {
  UlogStream stream(options.file);
  UlogPositions positions;
  UlogData data;
  while (stream.next(data)) positions.take(data);
  UlogFixes fixes(options, stream.name());
  for (const UlogPosition& p : positions.best()) fixes.take(p);
  return fixes.finish(stream.events());
}

}  // namespace coast::io
