#include "coast/record/imu_calibration.hpp"

#include <Eigen/LU>
#include <cmath>

namespace coast::record {

double ImuCalibration::gain_sd(int triad, int row, int column) const {
  const int i = triad + 3 + 3 * row + column;
  return std::sqrt(covariance(i, i));
}

double ImuCalibration::bias_sd(int triad, int axis) const {
  return std::sqrt(covariance(triad + axis, triad + axis));
}

void take_out(const ImuCalibration& calibration, ImuRecording& sensor) {
  const Eigen::Matrix3d gyro = (Eigen::Matrix3d::Identity() + calibration.gyro.gain).inverse();
  const Eigen::Matrix3d accel = (Eigen::Matrix3d::Identity() + calibration.accel.gain).inverse();
  for (ImuSample& sample : sensor.samples) {
    sample.dtheta = (gyro * (sample.dtheta - sample.dt * calibration.gyro.bias)).eval();
    sample.dv = (accel * (sample.dv - sample.dt * calibration.accel.bias)).eval();
  }
}

}  // namespace coast::record
