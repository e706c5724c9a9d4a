// The IMU of DataFlash logs: IMU, or GYR with ACC where they have more samples (AP_InertialSensor's LogStructure). Axes of the
// vehicle, forward, right, down: the autopilot has turned them by its mounting.

#include <fmt/format.h>

#include <algorithm>

#include "../boot_clock_imu.hpp"
#include "coast/record/error.hpp"
#include "dataflash_gnss.hpp"
#include "dataflash_readers.hpp"

namespace coast::io {

namespace {

std::optional<Eigen::Vector3d> dataflash_triad(const DataflashMessage& message, std::string_view x, std::string_view y,
                                               std::string_view z) {
  const auto a = message.number(x), b = message.number(y), c = message.number(z);
  return a && b && c ? std::optional(Eigen::Vector3d(*a, *b, *c)) : std::nullopt;
}

/// Samples of the first of redundant sensors.
class DataflashImuMessages {
 public:
  void take(const DataflashMessage& message) {
    const std::string& name = message.format->name;
    const bool imu = name == "IMU", gyro = name == "GYR" || name == "GYR1", accel = name == "ACC" || name == "ACC1";
    if ((!imu && !gyro && !accel) || message.instance() != 0) return;
    auto boot = imu ? message.boot_us("TimeUS", "TimeMS") : message.boot_us("SampleUS", "SampleMS");
    if (!boot) boot = message.boot_us("TimeUS", "TimeMS");
    if (!boot) return;
    const auto rates = dataflash_triad(message, "GyrX", "GyrY", "GyrZ"),
               forces = dataflash_triad(message, "AccX", "AccY", "AccZ");
    if (imu && rates && forces) both_.push_back({*boot, *rates, *forces});
    if (gyro && rates) gyros_.push_back({*boot, *rates});
    if (accel && forces) accels_.push_back({*boot, *forces});
  }

  /// Of the messages with more samples.
  [[nodiscard]] std::vector<BootImuRow> best() const {
    return both_.size() >= std::min(gyros_.size(), accels_.size()) ? both_ : paired_triads(gyros_, accels_);
  }

 private:
  std::vector<BootImuRow> both_;
  std::vector<BootTriad> gyros_, accels_;
};

/// GPS time of the autopilot's clock: of the receiver's messages when they arrived.
ClockTie dataflash_tie(const DataflashPositions& positions, const std::string& source) {
  constexpr double kMicrosecond = 1e-6;
  constexpr int kFix = 3;
  ClockTie tie(kMicrosecond);
  std::optional<geo::GpsTime> last;
  for (const DataflashPosition& p : positions.first()) {
    if (!p.t || p.status < kFix || p.t == last) continue;  // logged anew, it did not arrive anew
    tie.add(p.boot_us, *p.t);
    last = p.t;
  }
  if (!tie.fit())
    throw InputError({source, 0, "a log with fewer than ten positions with GPS time", "messages GPS",
                      "The samples have the autopilot's time only; its relation to GPS time follows from these."});
  return tie;
}

}  // namespace

record::ImuRecording read_dataflash_imu(const ImuFileOptions& options, Format::Near) {
  DataflashStream stream(options.file);
  DataflashImuMessages messages;
  DataflashPositions positions;
  DataflashMessage message;
  while (stream.next(message)) {
    messages.take(message);
    positions.take(message);
  }
  const std::vector<BootImuRow> rows = messages.best();
  if (rows.size() < 2)
    throw InputError(
        {stream.name(), 0, fmt::format("a log with {} IMU samples", rows.size()), "messages IMU, or GYR and ACC", ""});
  return boot_clock_imu(rows, dataflash_tie(positions, stream.name()), options, stream.name(), stream.events());
}

}  // namespace coast::io
