// IMU samples of VectorNav messages (VectorNav ICD for VN-310: common, time and IMU groups). Axes of the sensor as printed on
// it, turned by its reference frame rotation if one is set.

#include <fmt/format.h>

#include <cmath>

#include "../counted.hpp"
#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "coast/geo/units.hpp"
#include "vectornav_readers.hpp"
#include "vectornav_stream.hpp"
#include "vectornav_values.hpp"

namespace coast::io {

namespace {

/// What a sample is taken from, the best first.
enum class VectorNavSource : std::uint8_t {
  kIncrements,     ///< DeltaTheta, DeltaVel: coning and sculling compensated, of all samples since the message before
  kUncompensated,  ///< UncompGyro, UncompAccel: calibrated, without the biases that the sensor's own filter has found
  kCompensated,    ///< AngularRate, Accel: with them
};

struct VectorNavTriads {
  VectorNavSource source = VectorNavSource::kIncrements;
  Eigen::Vector3d gyro, accel;  ///< rad/s, m/s^2, or rad, m/s
};

std::optional<VectorNavTriads> triads_of(const VectorNavMessage& message) {
  using enum VectorNavGroup;
  constexpr std::size_t kAfterInterval = 4, kAfterVector = 12;
  const auto theta = message.field(kImu, 6), velocity = message.field(kImu, 7);
  if (theta && velocity)
    return VectorNavTriads{VectorNavSource::kIncrements, geo::kDegree * vector_at<float>(*theta, kAfterInterval),
                           vector_at<float>(*velocity)};
  if (const auto both = message.field(kCommon, 11))
    return VectorNavTriads{VectorNavSource::kIncrements, geo::kDegree * vector_at<float>(*both, kAfterInterval),
                           vector_at<float>(*both, kAfterInterval + kAfterVector)};
  const auto raw_accel = message.field(kImu, 2), raw_gyro = message.field(kImu, 3);
  if (raw_accel && raw_gyro)
    return VectorNavTriads{VectorNavSource::kUncompensated, vector_at<float>(*raw_gyro), vector_at<float>(*raw_accel)};
  if (const auto both = message.field(kCommon, 9))
    return VectorNavTriads{VectorNavSource::kUncompensated, vector_at<float>(*both, kAfterVector), vector_at<float>(*both)};
  const auto accel = message.field(kImu, 9), gyro = message.field(kImu, 10);
  if (accel && gyro) return VectorNavTriads{VectorNavSource::kCompensated, vector_at<float>(*gyro), vector_at<float>(*accel)};
  const auto common_accel = message.field(kCommon, 8), common_gyro = message.field(kCommon, 5);
  if (common_accel && common_gyro)
    return VectorNavTriads{VectorNavSource::kCompensated, vector_at<float>(*common_gyro), vector_at<float>(*common_accel)};
  return std::nullopt;
}

std::optional<float> temperature_of(const VectorNavMessage& message) {
  constexpr std::size_t kAfterMagnetometer = 12;
  if (const auto t = message.field(VectorNavGroup::kImu, 4)) return number_at<float>(*t, 0);
  if (const auto t = message.field(VectorNavGroup::kCommon, 10)) return number_at<float>(*t, kAfterMagnetometer);
  return std::nullopt;
}

class VectorNavImuReader {
 public:
  explicit VectorNavImuReader(const ImuFileOptions& options)
      : options_(options), stream_(options.file), order_(error_, repairs_) {}

  record::ImuRecording read() {
    recording_.source = stream_.name();
    VectorNavMessage message;
    while (stream_.next(message)) take(message);
    if (recording_.samples.size() < 2) refuse();
    finish();
    return std::move(recording_);
  }

 private:
  void take(const VectorNavMessage& message) {
    const auto triads = triads_of(message);
    if (!triads) return;
    ++rows_;
    const auto t = measurement_time(message);
    if (!t) {
      ++no_time_;
      return;
    }
    // A recording is of one kind: that of its first sample.
    if (!source_) source_ = triads->source;
    if (*source_ != triads->source) return;
    if (!triads->gyro.allFinite() || !triads->accel.allFinite()) {
      ++not_finite_;
      return;
    }
    const record::ImuSample sample{*t + options_.time.offset_s, 0.0, triads->gyro, triads->accel};
    require_possible(sample, error_);
    auto& samples = recording_.samples;
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (!order_.accept(sample.t, same)) return;
    samples.push_back(sample);
    const auto temperature = temperature_of(message);
    if (temperature && std::isfinite(*temperature)) recording_.temperature.push_back(*temperature);
  }

  void finish() {
    if (recording_.temperature.size() != recording_.samples.size()) recording_.temperature.clear();
    recording_.events = vectornav_file_events(stream_.census(), recording_.source);
    repairs_.finish(rows_, recording_.events);
    const auto add = [&](long number, const char* kind, const char* what, record::Event::Severity severity) {
      add_counted(recording_.events, recording_.source, {number}, {kind, "IMU sample", "IMU samples", what, severity});
    };
    using enum record::Event::Severity;
    add(no_time_, "imu_no_time", "before the sensor knew GPS time left out", kInfo);
    add(not_finite_, "nan_row", "with a value that is not finite left out", kWarning);
    if (source_ == VectorNavSource::kCompensated)
      add(static_cast<long>(recording_.samples.size()), "imu_compensated",
          "without the biases that the sensor's own filter has found, which change with it: let it write "
          "DeltaTheta and DeltaVel, or UncompGyro and UncompAccel",
          kWarning);
    finish_imu(recording_, source_ == VectorNavSource::kIncrements, options_.time_tag);
  }

  [[noreturn]] void refuse() const {
    if (rows_ > 1)
      throw InputError({stream_.name(), 0, fmt::format("{} IMU samples, {} of them without GPS time", rows_, no_time_),
                        "TimeGps, or TimeGpsTow with TimeGpsWeek, in the messages of the IMU",
                        "Add these fields to the output."});
    throw InputError({stream_.name(), 0, fmt::format("{} IMU samples in VectorNav messages", rows_),
                      "DeltaTheta and DeltaVel, UncompGyro and UncompAccel, or AngularRate and Accel", ""});
  }

  const ImuFileOptions& options_;
  VectorNavStream stream_;
  record::ImuRecording recording_;
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({stream_.name(), 0, fmt::format("IMU sample {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  std::optional<VectorNavSource> source_;
  long rows_ = 0, no_time_ = 0, not_finite_ = 0;
};

}  // namespace

record::ImuRecording read_vectornav_imu(const ImuFileOptions& options, Format::Near) {
  return VectorNavImuReader(options).read();
}

}  // namespace coast::io
