// Positions of flight logs: vehicle_gps_position and sensor_gps (PX4 user guide, uORB message reference; the names of the
// fields changed with version 1.14).

#include "ulog_gnss.hpp"

#include <cmath>
#include <cstdlib>

#include "../boot_clock_imu.hpp"
#include "../posix_time.hpp"
#include "../receiver_positions.hpp"
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
  constexpr std::int64_t kMicro = 1'000'000, kNanoseconds = 1'000;
  return gps_from_posix(us / kMicro, kNanoseconds * (us % kMicro));
}

std::optional<UlogPosition> position_of(const UlogRow& row) {
  const auto boot = row.integer("timestamp");
  const auto latitude = row.renamed("latitude_deg", "lat", 1e-7), longitude = row.renamed("longitude_deg", "lon", 1e-7);
  const auto height = row.renamed("altitude_ellipsoid_m", "alt_ellipsoid", 1e-3);
  if (!boot || *boot < 0 || *boot > kLongestUptime || !latitude || !longitude || !height) return std::nullopt;
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
  p.velocity_n = Eigen::Vector3d(*north, *east, *down);
  p.speed_sd = row.number("s_variance_m_s").value_or(0.0);  // a standard deviation by its unit and its use
  return p;
}

ReceiverPosition stated_by(const UlogPosition& p) {
  const auto quality = quality_of_fix_type(p.fix_type);
  ReceiverPosition position;
  position.t = p.t;
  position.solved = quality.has_value();
  position.r_ea_e = ecef_if_on_earth(p.place);
  position.position_cov_n = position_covariance(p.horizontal_sd, p.vertical_sd);
  position.v_ea_n = p.velocity_n;
  position.velocity_cov_n = velocity_covariance(p.speed_sd);
  position.quality = quality.value_or(record::FixQuality::kUnknown);
  position.satellites = p.satellites;
  return position;
}

}  // namespace

void UlogPositions::take(const UlogData& data) {
  const bool of_sensor = data.topic->name == "sensor_gps";
  if (!of_sensor && data.topic->name != "vehicle_gps_position") return;
  if (const auto p = position_of(UlogRow(data))) receivers_[{of_sensor, data.topic->instance}].push_back(*p);
}

std::span<const UlogPosition> UlogPositions::best() const {
  if (receivers_.empty()) return {};
  return receivers_.begin()->second;
}

record::GnssRecording read_ulog_gnss(const GnssFileOptions& options, Format::Near) {
  UlogStream stream(options.file);
  UlogPositions positions;
  UlogData data;
  while (stream.next(data)) positions.take(data);
  ReceiverPositions fixes(options, stream.name());
  for (const UlogPosition& p : positions.best()) fixes.take(stated_by(p));
  return fixes.finish(stream.events(), {.positions = {stream.name(), 0, "a flight log without positions",
                                                      "vehicle_gps_position or sensor_gps", ""},
                                        .for_time = "",
                                        .for_accuracy = "Give `sd_m: [n, e, d]` beside the file."});
}

}  // namespace coast::io
