// The IMU of flight logs: sensor_combined, or sensor_gyro with sensor_accel where they have more samples (PX4 user guide, uORB
// message reference). Axes of the vehicle, forward, right, down: the autopilot has turned them by its mounting.

#include <fmt/format.h>

#include <algorithm>

#include "../boot_clock_imu.hpp"
#include "coast/record/error.hpp"
#include "ulog_gnss.hpp"
#include "ulog_readers.hpp"

namespace coast::io {

namespace {

/// Fields of one topic, looked up once.
class UlogTriadReader {
 public:
  /// @param x  name of the three numbers, or of the first of three fields x, y, z
  UlogTriadReader(const UlogLayout& layout, std::string_view time, std::string_view x) {
    time_ = layout.find(time);
    if (!time_) time_ = layout.find("timestamp");
    const auto first = layout.find(x);
    if (first && first->count == 3)
      for (std::size_t i = 0; i < 3; ++i) axes_.at(i) = std::pair(*first, i);
    else if (first)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto field = layout.find(std::string_view("xyz").substr(i, 1));
        if (field) axes_.at(i) = std::pair(*field, std::size_t{0});
      }
  }
  [[nodiscard]] std::optional<BootTriad> operator()(std::string_view bytes) const {
    BootTriad triad;
    const auto time = time_ ? ulog_integer(bytes, *time_) : std::nullopt;
    if (!time || *time < 0 || *time > kLongestUptime) return std::nullopt;
    triad.boot_us = *time;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = axes_.at(i) ? ulog_number(bytes, axes_.at(i)->first, axes_.at(i)->second) : std::nullopt;
      if (!value) return std::nullopt;
      triad.value[static_cast<Eigen::Index>(i)] = *value;
    }
    return triad;
  }

 private:
  std::optional<UlogField> time_;
  std::array<std::optional<std::pair<UlogField, std::size_t>>, 3> axes_;
};

/// Samples of all topics with an IMU.
class UlogImuTopics {
 public:
  void take(const UlogData& data) {
    if (data.topic->instance != 0) return;  // the first of redundant sensors
    if (data.topic->name == "sensor_combined") {
      const auto gyro = reader(data, 0, "timestamp", "gyro_rad")(data.bytes);
      const auto accel = reader(data, 1, "timestamp", "accelerometer_m_s2")(data.bytes);
      if (gyro && accel) combined_.push_back({gyro->boot_us, gyro->value, accel->value});
    } else if (data.topic->name == "sensor_gyro") {
      if (const auto gyro = reader(data, 0, "timestamp_sample", "x")(data.bytes)) gyros_.push_back(*gyro);
    } else if (data.topic->name == "sensor_accel") {
      if (const auto accel = reader(data, 0, "timestamp_sample", "x")(data.bytes)) accels_.push_back(*accel);
    }
  }

  /// The topic with more samples.
  [[nodiscard]] std::vector<BootImuRow> best() const {
    return combined_.size() >= std::min(gyros_.size(), accels_.size()) ? combined_ : paired_triads(gyros_, accels_);
  }

 private:
  const UlogTriadReader& reader(const UlogData& data, int which, std::string_view time, std::string_view x) {
    const auto key = std::pair(data.id, which);
    const auto found = readers_.find(key);
    if (found != readers_.end()) return found->second;
    return readers_.emplace(key, UlogTriadReader(data.topic->layout, time, x)).first->second;
  }

  std::map<std::pair<std::uint16_t, int>, UlogTriadReader> readers_;
  std::vector<BootImuRow> combined_;
  std::vector<BootTriad> gyros_, accels_;
};

/// GPS time of the autopilot's clock: of the receiver's messages when they arrived.
ClockTie tie_of(const UlogPositions& positions, const std::string& source) {
  constexpr double kMicrosecond = 1e-6;
  ClockTie tie(kMicrosecond);
  for (const UlogPosition& p : positions.best())
    if (p.t) tie.add(p.boot_us, *p.t);
  if (!tie.fit())
    throw InputError({source, 0, "a flight log with fewer than ten GNSS messages with UTC",
                      "vehicle_gps_position or sensor_gps",
                      "The samples have the autopilot's time only; its relation to GPS time follows from these."});
  return tie;
}

}  // namespace

record::ImuRecording read_ulog_imu(const ImuFileOptions& options, Format::Near) {
  UlogStream stream(options.file);
  UlogImuTopics topics;
  UlogPositions positions;
  UlogData data;
  while (stream.next(data)) {
    topics.take(data);
    positions.take(data);
  }
  const std::vector<BootImuRow> rows = topics.best();
  if (rows.size() < 2)
    throw InputError({stream.name(), 0, fmt::format("a flight log with {} IMU samples", rows.size()),
                      "sensor_combined, or sensor_gyro and sensor_accel", ""});
  const ClockTie tie = tie_of(positions, stream.name());
  return boot_clock_imu(rows, tie, options, stream.name(), stream.events());
}

}  // namespace coast::io
