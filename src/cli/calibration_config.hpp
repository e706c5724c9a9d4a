#pragma once
// calibration.yaml: what `coast calibrate` estimates, and from which recordings.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/io/imu.hpp"
#include "coast/noise/calibration.hpp"
#include "coast/noise/static_recording.hpp"

namespace coast::cli {

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
  std::vector<CalibrationRecord> tested_on;  ///< records that the estimate is held against
  std::vector<SensorAxis> axes;
  noise::CalibrationOptions common;  ///< without what differs between the sensors
  struct PerSensor {
    std::vector<std::string> processes;  ///< empty: the model search
    noise::Mean mean = noise::Mean::kLevelAndDrift;
    std::optional<double> turn_on_bias;  ///< rad/s or m/s^2
  };
  std::array<PerSensor, 2> sensors;  ///< gyro, accelerometer

  [[nodiscard]] const PerSensor& of(noise::Sensor which) const { return sensors[which == noise::Sensor::kGyro ? 0 : 1]; }
  [[nodiscard]] noise::CalibrationOptions options(noise::Sensor which) const;
};

/// @param input  calibration.yaml, or an IMU file that says itself what it holds: then every option has its default
/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] CalibrationConfig read_calibration(const std::filesystem::path& input);

}  // namespace coast::cli
