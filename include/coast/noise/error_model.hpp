#pragma once

#include <array>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/noise/process.hpp"

namespace coast::noise {

/// The stochastic error model of one IMU (schema coast.imu_error_model/1): measured = truth + error, in sensor axes.
class ImuErrorModel {
 public:
  using Axes = std::array<std::vector<ProcessPtr>, 3>;  ///< x, y, z

  /// @throws InputError  anything that the schema does not allow, with file and line
  [[nodiscard]] static ImuErrorModel from(const config::Node& file);

  /// From processes at hand.
  [[nodiscard]] static ImuErrorModel of(std::string sensor_name, double rate_hz, Axes gyro, Axes accel);

  [[nodiscard]] const Axes& axes(Sensor sensor) const { return sensor == Sensor::kGyro ? gyro_ : accel_; }
  /// White noise of an axis as a filter takes it, [signal]^2/Hz: the white densities, and what may be taken for white.
  [[nodiscard]] geo::Psd white_density(Sensor sensor, int axis) const;
  /// Standard deviation of the additive states of an axis at the start, [signal]: what alignment has to expect of a bias.
  [[nodiscard]] double bias_sd(Sensor sensor, int axis) const;
  /// Whose errors the model has shares of, in the order in which they first appear.
  [[nodiscard]] std::vector<std::string> members() const;
  [[nodiscard]] const std::string& sensor_name() const { return sensor_name_; }
  /// The same model with every white-noise density of one sensor multiplied (`factor` scales the standard deviation). Rounding
  /// of samples is white noise to a filter and becomes such under a factor other than 1.
  [[nodiscard]] ImuErrorModel with_white_noise_scaled(Sensor sensor, double factor) const;
  /// The file again, in SI units.
  [[nodiscard]] std::string yaml() const;

 private:
  std::string sensor_name_;
  double rate_hz_ = 0.0;
  Axes gyro_;
  Axes accel_;
};

}  // namespace coast::noise
