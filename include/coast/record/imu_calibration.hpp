#pragma once
// Constant errors of an IMU as found by a calibration, with their uncertainty, and their removal from a recording.

#include <Eigen/Core>
#include <string>

#include "coast/record/imu.hpp"

namespace coast::record {

/// Constant errors of one triad: measured = (I + gain) true + bias, sensor axes.
struct TriadErrors {
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();  ///< diagonal: scale errors; row i: misalignment of axis i, rad
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< rad/s or m/s^2
};

/// Scale, misalignment and bias of gyros and accelerometers.
struct ImuCalibration {
  /// Number of values, and where each triad begins in the covariance: bias x, y, z, then gain xx, xy, xz, yx, ..., zz.
  static constexpr int kValues = 24;
  static constexpr int kAccel = 0;
  static constexpr int kGyro = 12;

  std::string sensor;  ///< name of the product
  TriadErrors accel;
  TriadErrors gyro;
  Eigen::Matrix<double, kValues, kValues> covariance = Eigen::Matrix<double, kValues, kValues>::Zero();

  /// Standard deviation of gain(row, column) of the triad that begins at kAccel or kGyro.
  [[nodiscard]] double gain_sd(int triad, int row, int column) const;
  [[nodiscard]] double bias_sd(int triad, int axis) const;
};

/// Replaces the increments of every sample by those of error-free sensors: (I + gain)^-1 (increment - bias dt).
/// @param sensor  in the axes of the sensor that was calibrated
void take_out(const ImuCalibration& calibration, ImuRecording& sensor);

}  // namespace coast::record
