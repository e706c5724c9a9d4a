#pragma once
// Sensors of the tests: an error model from the processes of its axes, and an IMU whose rate and specific force are constant.

#include <fmt/format.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "coast/io/yaml.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/imu.hpp"

namespace coast::simulate {

/// An error model at 100 Hz with these processes on all axes.
inline noise::ImuErrorModel error_model(const std::string& gyro, const std::string& accel = {}) {
  return noise::ImuErrorModel::from(io::parse_yaml(
      fmt::format("schema: coast.imu_error_model/1\nrate_hz: 100\ngyro: {{all: [{}]}}\naccel: {{all: [{}]}}\n", gyro, accel),
      "model.yaml"));
}

inline record::ImuRecording constant_truth(std::size_t count, double dt, const Eigen::Vector3d& rate,
                                           const Eigen::Vector3d& force) {
  record::ImuRecording truth;
  truth.rate_hz = 1.0 / dt;
  truth.samples.resize(count);
  for (std::size_t k = 0; k < count; ++k)
    truth.samples[k] = {geo::GpsTime{} + dt * static_cast<double>(k + 1), dt, dt * rate, dt * force};
  return truth;
}

}  // namespace coast::simulate
