// The receiver's IMU, or one connected to it: UBX-ESF-RAW and UBX-ESF-MEAS (u-blox ZED-F9R interface description). Sensor axes
// as printed on the module, specific force and angular rate.

#include <fmt/format.h>

#include <cmath>

#include "../binary.hpp"
#include "../clock_tie.hpp"
#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "coast/geo/units.hpp"
#include "ubx_messages.hpp"
#include "ubx_readers.hpp"

namespace coast::io {

namespace {

/// "ESF measurement data": types of data, with their scale. Other types are wheel ticks and speeds.
enum EsfType : std::uint8_t {
  kGyroZ = 5,
  kGyroTemperature = 12,
  kGyroY = 13,
  kGyroX = 14,
  kAccelX = 16,
  kAccelY = 17,
  kAccelZ = 18
};

/// Puts samples together from single numbers: rates and forces may come with one tag, or alternately with their own.
class EsfSamples {
 public:
  struct Sample {
    std::int64_t tag;
    Eigen::Vector3d gyro, accel;  ///< rad/s, m/s^2
    float temperature;            ///< degC, NaN where none has come
  };

  void take(std::uint8_t type, std::uint32_t field, std::uint32_t tag) {
    constexpr double kRate = geo::kDegree / 4096.0, kForce = 1.0 / 1024.0, kTemperature = 0.01;
    const double value = (static_cast<double>((field & 0xffffffU) ^ 0x800000U)) - 0x800000;  // 24 bits, two's complement
    switch (type) {
      case kGyroX:
      case kGyroY:
      case kGyroZ:
        set(gyro_, type == kGyroX ? 0 : type == kGyroY ? 1 : 2, kRate * value, tag);
        break;
      case kAccelX:
      case kAccelY:
      case kAccelZ:
        set(accel_, type - kAccelX, kForce * value, tag);
        break;
      case kGyroTemperature:
        temperature_ = static_cast<float>(kTemperature * value);
        break;
      default:
        break;
    }
    if (gyro_.known != kAll || accel_.known != kAll) return;
    samples_.push_back({std::max(gyro_.tag, accel_.tag), gyro_.value, accel_.value, temperature_});
    gyro_.known = accel_.known = 0;
  }
  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }

 private:
  static constexpr unsigned kAll = 7;
  struct Triad {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    unsigned known = 0;  ///< a bit for each axis
    std::int64_t tag = 0;
  };
  void set(Triad& triad, int axis, double value, std::uint32_t tag) {
    const std::int64_t at = unwrap_(tag);
    if (at != triad.tag) triad.known = 0;  // what was not complete is of another instant
    triad.tag = at;
    triad.value[axis] = value;
    triad.known |= 1U << axis;
  }

  Triad gyro_, accel_;
  CounterUnwrap unwrap_;
  float temperature_ = NAN;
  std::vector<Sample> samples_;
};

/// One source of samples with its clock.
struct EsfSource {
  EsfSamples samples;
  ClockTie tie;
  std::size_t tied = 0;  ///< number of samples when the last pair was made

  /// GPS time stated next after a sample: on average it is that of the sample.
  void note(geo::GpsTime t) {
    if (samples.samples().size() == tied) return;
    tied = samples.samples().size();
    tie.add(samples.samples().back().tag, t);
  }
};

void take_measurements(std::string_view b, EsfSource& source) {
  constexpr std::size_t kHead = 8;
  if (b.size() < kHead) return;
  const std::size_t number = number_at<std::uint16_t>(b, 4) >> 11U;
  if (b.size() < kHead + 4 * number) return;
  for (std::size_t i = 0; i < number; ++i) {
    const auto data = number_at<std::uint32_t>(b, kHead + 4 * i);
    source.samples.take(static_cast<std::uint8_t>(data >> 24 & 0x3fU), data, number_at<std::uint32_t>(b, 0));
  }
}

void take_raw(std::string_view b, EsfSource& source) {
  constexpr std::size_t kHead = 4, kRawBlock = 8;
  for (std::size_t at = kHead; at + kRawBlock <= b.size(); at += kRawBlock) {
    const auto data = number_at<std::uint32_t>(b, at);
    source.samples.take(static_cast<std::uint8_t>(data >> 24), data, number_at<std::uint32_t>(b, at + 4));
  }
}

[[noreturn]] void refuse_imu(const FrameStream& stream, std::size_t samples) {
  const auto number = [&](std::uint32_t id) { return stream.census().number(Protocol::kUbx, id); };
  if (samples > 1)
    throw InputError({stream.name(), 0,
                      fmt::format("{} IMU samples with fewer than ten epochs of GPS time among them", samples),
                      "UBX-NAV-PVT or UBX-RXM-RAWX beside them, for ten seconds at least",
                      "The samples have the time of a counter only; its relation to GPS time follows from these."});
  throw InputError({stream.name(), 0,
                    number(ubx::kEsfRaw) + number(ubx::kEsfMeas) == 0
                        ? std::string("a UBX file without UBX-ESF-RAW and UBX-ESF-MEAS")
                        : std::string("UBX-ESF messages without rates and specific forces"),
                    "IMU samples", "Only receivers with sensors send them; name the file of the IMU under `imu`."});
}

record::ImuRecording recording_of(const EsfSource& source, const FrameStream& stream, const ImuFileOptions& options) {
  record::ImuRecording recording;
  recording.source = stream.name();
  long row = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError(
        {stream.name(), 0, fmt::format("IMU sample {}: {}", row, found), std::move(expected), std::move(what_to_do)});
  };
  Repairs repairs;
  TimeOrder order(error, repairs);
  constexpr double kMostWithoutTime = 0.01;  // share of the samples
  bool temperature = true;
  for (const EsfSamples::Sample& s : source.samples.samples()) {
    ++row;
    auto& samples = recording.samples;
    const auto t = source.tie.at(s.tag);
    if (!t) {
      repairs.add("imu_no_time", "with a counter far from those of the positions left out", kMostWithoutTime,
                  error("a counter far from the others", "increasing", ""), std::nullopt);
      continue;
    }
    const record::ImuSample sample{*t + options.time.offset_s, 0.0, s.gyro, s.accel};
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (!order.accept(sample.t, same)) continue;
    samples.push_back(sample);
    recording.temperature.push_back(s.temperature);
    temperature = temperature && std::isfinite(s.temperature);
  }
  if (!temperature) recording.temperature.clear();
  recording.events = ubx_file_events(stream.census(), stream.name());
  repairs.finish(row, recording.events);
  recording.events.push_back(
      {record::Event::Severity::kInfo, "imu_clock_tied",
       fmt::format(
           "{}: IMU times follow from the order of the messages, one count being {:.6g} s: they scatter by {:.3f} s, and "
           "are early by the receiver's computing time, some 0.1 s. Without `gnss.time_offset_s` the rest is found from "
           "the motion",
           stream.name(), source.tie.tick_s(), source.tie.median_distance_s()),
       std::nullopt, 1});
  finish_imu(recording, false, options.time_tag);
  return recording;
}

}  // namespace

record::ImuRecording read_ubx_imu(const ImuFileOptions& options, Format::Near) {
  FrameStream stream(options.file, kUbxLog);
  EsfSource raw, measurements;
  MessageFrame frame;
  while (stream.next(frame)) {
    if (frame.protocol != Protocol::kUbx) continue;
    if (frame.id == ubx::kEsfRaw) take_raw(frame.payload, raw);
    if (frame.id == ubx::kEsfMeas) take_measurements(frame.payload, measurements);
    if (const auto t = stated_time(frame)) {
      raw.note(*t);
      measurements.note(*t);
    }
  }
  // The same sensors: ESF-RAW has every sample, ESF-MEAS fewer.
  EsfSource& source = raw.samples.samples().size() > 1 ? raw : measurements;
  if (source.samples.samples().size() < 2 || !source.tie.fit()) refuse_imu(stream, source.samples.samples().size());
  return recording_of(source, stream, options);
}

}  // namespace coast::io
