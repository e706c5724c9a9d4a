#pragma once

#include <array>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/noise/process.hpp"
#include "coast/record/imu_calibration.hpp"

namespace coast::noise {

/// The stochastic error model of one IMU (schema coast.imu_error_model/1): measured = truth + error, in sensor axes.
class ImuErrorModel {
 public:
  using Axes = std::array<std::vector<ProcessPtr>, 3>;  ///< x, y, z

  /// @throws InputError  anything that the schema does not allow; with file and line
  [[nodiscard]] static ImuErrorModel from(const config::Node& file);

  /// From existing processes.
  [[nodiscard]] static ImuErrorModel of(std::string sensor_name, double rate_hz, Axes gyro, Axes accel);

  [[nodiscard]] const Axes& axes(Sensor sensor) const { return sensor == Sensor::kGyro ? gyro_ : accel_; }
  /// White-noise density of an axis as used by a filter, [signal]^2/Hz: the white densities, and processes that a filter may
  /// treat as white (Process::as_white).
  [[nodiscard]] geo::Psd white_density(Sensor sensor, int axis) const;
  /// Standard deviation of the additive states of an axis at the start, [signal]: the bias uncertainty for alignment.
  [[nodiscard]] double bias_sd(Sensor sensor, int axis) const;
  /// Names of the IMUs whose errors have a share in the model, in order of first appearance.
  [[nodiscard]] std::vector<std::string> members() const;
  [[nodiscard]] const std::string& sensor_name() const { return sensor_name_; }
  /// The same model with every white-noise density of one sensor scaled (factors of x, y and z apply to the standard
  /// deviation). A filter treats rounding of samples as white noise; with a factor other than 1 it is converted to white noise.
  [[nodiscard]] ImuErrorModel with_white_noise_scaled(Sensor sensor, const Eigen::Vector3d& factors) const;
  /// The model of an IMU whose calibration was taken out of the recording: constant scale factors and misalignments keep the
  /// uncertainty of the calibration, and a tenth of their own for temperature and age; none is added or made larger.
  [[nodiscard]] ImuErrorModel with_gains_known(const record::ImuCalibration& calibration) const;
  /// The model as a file, in SI units.
  [[nodiscard]] std::string yaml() const;

 private:
  std::string sensor_name_;
  double rate_hz_ = 0.0;
  Axes gyro_;
  Axes accel_;
};

}  // namespace coast::noise
