#pragma once
// Static records -> IMU error model with intervals, and parameters that they cannot determine.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/imu.hpp"
#include "coast/jobs/job.hpp"
#include "coast/noise/calibration.hpp"
#include "coast/noise/static_recording.hpp"
#include "coast/record/event.hpp"

namespace coast::jobs {

/// One axis of the sensor.
struct SensorAxis {
  noise::Sensor sensor = noise::Sensor::kGyro;
  int axis = 0;  ///< x, y, z

  [[nodiscard]] std::string sensor_name() const { return sensor == noise::Sensor::kGyro ? "gyro" : "accel"; }
  [[nodiscard]] std::string axis_name() const { return std::string(1, "xyz"[axis]); }
  [[nodiscard]] std::string key() const { return sensor_name() + "_" + axis_name(); }  ///< "gyro_x"
  [[nodiscard]] std::string title() const;                                             ///< "Gyro x"
};

/// One static recording.
struct CalibrationRecord {
  io::ImuFileOptions file;
  noise::RecordingPart part;
};

struct CalibrationConfig {
  std::filesystem::path file;
  std::string sensor;  ///< name of the product
  std::vector<CalibrationRecord> records;
  std::vector<CalibrationRecord> tested_on;  ///< records used to test the estimate
  std::vector<SensorAxis> axes;
  noise::CalibrationOptions common;  ///< common options, without those of PerSensor
  struct PerSensor {
    std::vector<std::string> processes;  ///< empty: the model search
    noise::Mean mean = noise::Mean::kLevelAndDrift;
    std::optional<double> turn_on_bias;  ///< rad/s or m/s^2
  };
  std::array<PerSensor, 2> sensors;  ///< gyro, accelerometer

  [[nodiscard]] const PerSensor& of(noise::Sensor which) const { return sensors[which == noise::Sensor::kGyro ? 0 : 1]; }
  [[nodiscard]] noise::CalibrationOptions options(noise::Sensor which) const;
};

/// @param input  calibration.yaml, or a self-describing IMU file: then every option has its default
/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] CalibrationConfig read_calibrate(const std::filesystem::path& input);
[[nodiscard]] CalibrationConfig read_calibrate(const config::Node& root);
/// The calibration.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string calibration_example(const std::string& indent);

/// One recording as it was read.
struct ReadRecord {
  std::string source;
  double duration = 0.0;     ///< s, holes included
  std::uint64_t length = 0;  ///< intervals, holes included
  std::size_t samples = 0;
  std::size_t holes = 0;
  std::vector<std::string> remarks;
};

/// The chosen sum fitted to one of several records alone.
struct OwnEstimate {
  std::vector<double> u;
  std::vector<double> sd;  ///< of each u, Cramer-Rao; infinite: not determined
};

/// A record used to test the estimate.
struct TestedRecord {
  std::string source;
  noise::RecordTest test;
};

struct CalibratedAxis {
  SensorAxis axis;
  std::vector<noise::StaticSignal> signals;  ///< of each record used in the estimate
  noise::AxisCalibration result;
  std::vector<OwnEstimate> own;  ///< of each record, if there are several
  std::vector<TestedRecord> tests;
};

struct CalibrationResult {
  double interval = 0.0;  ///< s
  std::vector<ReadRecord> records;
  std::vector<ReadRecord> tested_on;
  record::Events events;  ///< of the readers
  std::vector<CalibratedAxis> axes;

  /// Axes of one sensor, in order.
  [[nodiscard]] std::vector<const CalibratedAxis*> of(noise::Sensor sensor) const {
    std::vector<const CalibratedAxis*> list;
    for (const CalibratedAxis& axis : axes)
      if (axis.axis.sensor == sensor) list.push_back(&axis);
    return list;
  }
};

/// @throws InputError  a record with motion, or too short  @throws NumericalError  an axis that cannot be estimated
[[nodiscard]] CalibrationResult calibrate(const CalibrationConfig& config, const Progress& progress);
/// The same for recordings in memory: those of config.records, then those of config.tested_on.
[[nodiscard]] CalibrationResult calibrate(const CalibrationConfig& config, const std::vector<record::ImuRecording>& recordings,
                                          const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const CalibrationConfig& config);
/// error_model.yaml, calibration.json (docs/schema/calibration.schema.json), report.html.
void write(const CalibrationConfig& config, const CalibrationResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const CalibrationConfig& config, const CalibrationResult& result,
                               const std::filesystem::path& folder);

}  // namespace coast::jobs
