// The IMU of a bag: one topic of sensor_msgs/Imu. Its axes are as they were recorded: REP 103 asks for forward, left, up, but
// not all drivers follow it.

#include <fmt/format.h>

#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "bag_readers.hpp"
#include "bag_topics.hpp"
#include "coast/record/error.hpp"
#include "ros_message.hpp"

namespace coast::io {

namespace {

struct BagImuRow {
  std::int64_t log_ns = 0;
  RosImu imu;
};

class BagImuBuilder {
 public:
  BagImuBuilder(const ImuFileOptions& options, std::optional<geo::GpsTime> near, std::string file)
      : options_(options), file_(std::move(file)), times_(options.time, near, error_), order_(error_, repairs_) {}

  void take(const BagImuRow& row) {
    ++rows_;
    if (!row.imu.measured) return not_measured_.add();
    if (!row.imu.gyro.allFinite() || !row.imu.accel.allFinite()) return not_finite_.add();
    const auto t = times_.at(row.imu.stamp_ns, row.log_ns);
    if (!t) return no_time_.add();
    const record::ImuSample sample{*t, 0.0, options_.gyro_to_si * row.imu.gyro, options_.accel_to_si * row.imu.accel};
    require_possible(sample, error_);
    auto& samples = recording_.samples;
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (order_.accept(*t, same)) samples.push_back(sample);
  }

  record::ImuRecording finish(record::Events damage) {
    if (recording_.samples.size() < 2)
      throw InputError(
          {file_, 0,
           fmt::format("{} messages of an IMU, of which {} can be used: {} without both sensors, {} with values "
                       "that are not finite, {} with stamps outside the years 2000 to 2100",
                       rows_, recording_.samples.size(), not_measured_.number, not_finite_.number, no_time_.number),
           "at least two",
           no_time_.number > 0 ? "If the stamps count from a start, state `time: {kind: elapsed}` and `gps_week`." : ""});
    recording_.source = file_;
    recording_.events = std::move(damage);
    auto& events = recording_.events;
    repairs_.finish(rows_, events);
    times_.report(events, file_);
    const auto add = [&](const Counted& counted, const char* kind, const char* what) {
      add_counted(events, file_, counted, {kind, "IMU message", "IMU messages", what});
    };
    add(not_measured_, "bag_sensor_missing", "without gyro or accelerometer by their covariance of -1 left out");
    add(not_finite_, "nan_row", "with a value that is not finite left out");
    add(no_time_, "bag_stamp_impossible", "with stamps outside the years 2000 to 2100 left out");
    finish_imu(recording_, false, options_.time_tag);
    return std::move(recording_);
  }

 private:
  const ImuFileOptions& options_;
  std::string file_;
  long rows_ = 0;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({file_, 0, fmt::format("IMU message {}: {}", rows_, found), expected, what_to_do});
  };
  BagTimes times_;
  Repairs repairs_;
  TimeOrder order_;
  record::ImuRecording recording_;
  Counted not_measured_, not_finite_, no_time_;
};

}  // namespace

record::ImuRecording read_bag_imu(OpenBag open, const ImuFileOptions& options, Format::Near near) {
  const auto stream = open(options.file);
  BagRows<BagImuRow> topics({options.topic, "imu", std::string(kRosImuType)});
  BagMessage message;
  while (stream->next(message)) {
    if (message.topic->type != kRosImuType || !is_decoded(*message.topic)) continue;
    const auto imu = ros_imu(message);
    topics.add(*message.topic, imu ? std::optional(BagImuRow{message.log_ns, *imu}) : std::nullopt);
  }
  record::Events events = stream->events();
  const auto rows = topics.chosen(stream->name(), events);
  BagImuBuilder builder(options, near, stream->name());
  for (const BagImuRow& row : rows) builder.take(row);
  return builder.finish(std::move(events));
}

}  // namespace coast::io
