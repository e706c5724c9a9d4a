// The IMU of flight logs: sensor_combined, or sensor_gyro with sensor_accel where they have more samples (PX4 user guide, uORB
// message reference). Axes of the vehicle, forward, right, down: the autopilot has turned them by its mounting.

#include <fmt/format.h>

#include <algorithm>

#include "../clock_tie.hpp"
#include "../counted.hpp"
#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "ulog_gnss.hpp"
#include "ulog_readers.hpp"

namespace coast::io {

namespace {

/// A triad at the autopilot's time.
struct UlogTriad {
  std::int64_t boot_us = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

struct UlogImuSample {
  std::int64_t boot_us = 0;
  Eigen::Vector3d gyro, accel;  ///< rad/s, m/s^2
};

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
  [[nodiscard]] std::optional<UlogTriad> operator()(std::string_view bytes) const {
    UlogTriad triad;
    const auto time = time_ ? ulog_integer(bytes, *time_) : std::nullopt;
    if (!time || *time < 0 || *time > kLongestUlogUptime) return std::nullopt;
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
  [[nodiscard]] std::vector<UlogImuSample> best() const {
    return combined_.size() >= std::min(gyros_.size(), accels_.size()) ? combined_ : paired();
  }

 private:
  const UlogTriadReader& reader(const UlogData& data, int which, std::string_view time, std::string_view x) {
    const auto key = std::pair(data.id, which);
    const auto found = readers_.find(key);
    if (found != readers_.end()) return found->second;
    return readers_.emplace(key, UlogTriadReader(data.topic->layout, time, x)).first->second;
  }

  /// Specific forces interpolated to the times of the gyro, whose samples are not taken at the same instants.
  [[nodiscard]] std::vector<UlogImuSample> paired() const {
    std::vector<UlogImuSample> samples;
    std::size_t next = 1;
    for (const UlogTriad& gyro : gyros_) {
      while (next < accels_.size() && accels_[next].boot_us < gyro.boot_us) ++next;
      if (next >= accels_.size()) break;
      const UlogTriad &a = accels_[next - 1], &b = accels_[next];
      if (gyro.boot_us < a.boot_us || b.boot_us <= a.boot_us) continue;
      const double share = static_cast<double>(gyro.boot_us - a.boot_us) / static_cast<double>(b.boot_us - a.boot_us);
      samples.push_back({gyro.boot_us, gyro.value, a.value + share * (b.value - a.value)});
    }
    return samples;
  }

  std::map<std::pair<std::uint16_t, int>, UlogTriadReader> readers_;
  std::vector<UlogImuSample> combined_;
  std::vector<UlogTriad> gyros_, accels_;
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
  const std::vector<UlogImuSample> rows = topics.best();
  if (rows.size() < 2)
    throw InputError({stream.name(), 0, fmt::format("a flight log with {} IMU samples", rows.size()),
                      "sensor_combined, or sensor_gyro and sensor_accel", ""});
  const ClockTie tie = tie_of(positions, stream.name());
  record::ImuRecording recording;
  recording.source = stream.name();
  long row = 0, not_finite = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError(
        {stream.name(), 0, fmt::format("IMU sample {}: {}", row, found), std::move(expected), std::move(what_to_do)});
  };
  Repairs repairs;
  TimeOrder order(error, repairs);
  for (const UlogImuSample& s : rows) {
    ++row;
    const auto t = tie.at(s.boot_us);
    if (!t || !s.gyro.allFinite() || !s.accel.allFinite()) {
      ++not_finite;
      continue;
    }
    const record::ImuSample sample{*t + options.time.offset_s, 0.0, s.gyro, s.accel};
    require_possible(sample, error);
    auto& samples = recording.samples;
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (order.accept(sample.t, same)) samples.push_back(sample);
  }
  recording.events = stream.events();
  repairs.finish(row, recording.events);
  add_counted(recording.events, stream.name(), {not_finite},
              {"nan_row", "IMU sample", "IMU samples", "with a value that is not finite, or an impossible time, left out"});
  recording.events.push_back(
      {record::Event::Severity::kInfo, "imu_clock_tied",
       fmt::format(
           "{}: IMU times follow from when GNSS messages arrived, which scatter by {:.3f} s: they are early by the delay of "
           "these, some 0.1 s. Without `gnss.time_offset_s` the rest is found from the motion",
           stream.name(), tie.median_distance_s()),
       std::nullopt, 1});
  finish_imu(recording, false, options.time_tag);
  return recording;
}

}  // namespace coast::io
