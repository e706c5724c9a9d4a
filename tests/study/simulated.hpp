#pragma once
// Simulated missions that the tests of this room process.

#include <memory>

#include "coast/io/yaml.hpp"
#include "coast/simulate/scenario.hpp"
#include "coast/study/solution.hpp"

namespace coast::test {

/// A tactical IMU: white noise, turn-on constants, scale factors.
inline noise::ImuErrorModel tactical_model() {
  return noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
sensor: test
gyro:
  all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: random_constant, sigma: 5, unit: deg/h}]
accel:
  all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 1, unit: mg}]
)",
                                                   "model.yaml"));
}

/// A city drive with a roundabout, 10 Hz GNSS at the antenna.
inline simulate::Scenario drive(double duration_s, std::uint64_t seed) {
  simulate::Scenario scenario =
      simulate::Scenario::from(io::parse_yaml(R"(
schema: coast.scenario/1
trajectory: {kind: car_roundabout, duration_s: )" +
                                                  std::to_string(duration_s) +
                                                  R"(, static_s: 30, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 5, sd_m: [0.01, 0.01, 0.02]}
start_gps: {week: 2374, sow: 208800}
)",
                                              "scenario.yaml"),
                               [](const std::filesystem::path& file) { return io::load_yaml(file); });
  scenario.error_model = tactical_model();
  scenario.seed = seed;
  return scenario;
}

inline study::Setup setup_of(const simulate::Scenario& scenario) {
  study::Setup setup;
  setup.model = *scenario.error_model;
  setup.lever_arm_b = scenario.gnss.lever_arm_b;
  return setup;
}

}  // namespace coast::test
