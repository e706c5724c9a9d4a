// The IMU of a receiver that has one: ExtSensorMeas of SBF. Specific force and angular rate along the axes of the sensor as
// printed on it, before the orientation that has been set in the receiver. A recording of an AsteRx shows it, whose IMU is
// mounted upside down and turned by 90 deg: rates along its axes are those of the receiver's attitude turned back by
// the orientation in IMUSetup, and the force along z is +9.8 m/s^2.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../counted.hpp"
#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "coast/geo/units.hpp"
#include "sbf_blocks.hpp"
#include "sbf_readers.hpp"

namespace coast::io {

namespace {

struct SbfImuSample {
  std::optional<Eigen::Vector3d> gyro, accel;  ///< rad/s, m/s^2
  std::optional<float> temperature;            ///< degC
  bool unknown = false;                        ///< a component that the receiver does not know
};

class SbfImuReader {
 public:
  explicit SbfImuReader(const ImuFileOptions& options)
      : options_(options), stream_(options.file, kSbfLog), order_(error_, repairs_) {}

  record::ImuRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame))
      if (frame.protocol == Protocol::kSbf && frame.id == sbf::kExtSensorMeas) take(frame.payload);
    if (recording_.samples.size() < 2) refuse();
    finish();
    return std::move(recording_);
  }

 private:
  void take(std::string_view payload);
  [[nodiscard]] SbfImuSample sample_of(std::string_view payload);
  void finish();
  [[noreturn]] void refuse() const;

  const ImuFileOptions& options_;
  FrameStream stream_;
  record::ImuRecording recording_;
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({stream_.name(), 0, fmt::format("IMU sample {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  std::optional<int> sensor_;  ///< source and model of the first
  float temperature_ = NAN;
  long rows_ = 0, no_time_ = 0, unknown_ = 0, other_ = 0;
};

/// Sets of measurements: source, model, type, information, then numbers of that type. A block has sets of one instant.
SbfImuSample SbfImuReader::sample_of(std::string_view payload) {
  constexpr std::size_t kFirst = 8, kShortest = 28;
  enum Type : std::uint8_t { kAcceleration = 0, kAngularRate = 1, kInfo = 3 };
  SbfImuSample sample;
  if (payload.size() < kFirst) return sample;
  const std::size_t sets = number_at<std::uint8_t>(payload, 6), size = number_at<std::uint8_t>(payload, 7);
  if (size < kShortest || payload.size() < kFirst + sets * size) return sample;
  for (std::size_t i = 0; i < sets; ++i) {
    SbfFields f(payload, kFirst + i * size);
    const int sensor = f.u2();
    const int type = f.u1();
    f.skip(1);
    if (type == kInfo) {
      constexpr int kNoTemperature = INT16_MIN;
      const int hundredths = f.next<std::int16_t>();
      if (hundredths != kNoTemperature && sensor == sensor_) sample.temperature = static_cast<float>(0.01 * hundredths);
    }
    if (type != kAcceleration && type != kAngularRate) continue;
    if (!sensor_) sensor_ = sensor;
    if (sensor != *sensor_) {
      ++other_;
      continue;
    }
    const double x = f.f8(), y = f.f8(), z = f.f8();
    sample.unknown = sample.unknown || !sbf_known(x) || !sbf_known(y) || !sbf_known(z);
    const Eigen::Vector3d value(x, y, z);
    if (type == kAcceleration)
      sample.accel = value;
    else
      sample.gyro = geo::kDegree * value;
  }
  return sample;
}

void SbfImuReader::take(std::string_view payload) {
  const SbfImuSample s = sample_of(payload);
  if (s.temperature) temperature_ = *s.temperature;
  if (!s.gyro || !s.accel) return;
  ++rows_;
  if (s.unknown) {
    ++unknown_;
    return;
  }
  const auto t = sbf_time(payload);
  if (!t) {
    ++no_time_;
    return;
  }
  const record::ImuSample sample{*t + options_.time.offset_s, 0.0, *s.gyro, *s.accel};
  require_possible(sample, error_);
  auto& samples = recording_.samples;
  const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
  if (!order_.accept(sample.t, same)) return;
  samples.push_back(sample);
  recording_.temperature.push_back(temperature_);
}

void SbfImuReader::finish() {
  // The temperature comes once a second: the samples before its first value have that one.
  auto& temperature = recording_.temperature;
  const auto first = std::ranges::find_if(temperature, [](float t) { return std::isfinite(t); });
  if (first == temperature.end())
    temperature.clear();
  else
    std::fill(temperature.begin(), first, *first);
  recording_.events = sbf_file_events(stream_.census(), recording_.source);
  repairs_.finish(rows_, recording_.events);
  const auto add = [&](long number, const char* kind, const char* what, record::Event::Severity severity) {
    add_counted(recording_.events, recording_.source, {number}, {kind, "IMU sample", "IMU samples", what, severity});
  };
  using enum record::Event::Severity;
  add(no_time_, "imu_no_time", "before the receiver knew GPS time left out", kInfo);
  add(unknown_, "nan_row", "with a value that the receiver does not know left out", kWarning);
  add(other_, "imu_other_sensor", "of another sensor than the first left out", kInfo);
  finish_imu(recording_, false, options_.time_tag);
}

void SbfImuReader::refuse() const {
  if (stream_.census().number(Protocol::kSbf, sbf::kExtSensorMeas) == 0)
    throw InputError({stream_.name(), 0, "an SBF file without ExtSensorMeas", "IMU samples",
                      "Only receivers with an IMU send them; name the file of the IMU under `imu`."});
  throw InputError({stream_.name(), 0,
                    fmt::format("{} IMU samples in ExtSensorMeas, {} of them without GPS time", rows_, no_time_),
                    "at least two with angular rate and acceleration", ""});
}

}  // namespace

record::ImuRecording read_sbf_imu(const ImuFileOptions& options, Format::Near) {
  return SbfImuReader(options).read();
}

}  // namespace coast::io
