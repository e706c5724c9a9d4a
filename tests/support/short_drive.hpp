#pragma once
// A recording that is simulated in a moment, for tests of whole jobs.

namespace coast::test {

/// A MEMS IMU, for simulated recordings.
inline constexpr const char* kTestModel = R"(
schema: coast.imu_error_model/1
sensor: test
gyro: {all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: random_constant, sigma: 5, unit: deg/h}]}
accel: {all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 1, unit: mg}]}
)";

/// A short drive through a town, with the antenna not at the IMU.
inline constexpr const char* kShortDrive = R"(
schema: coast.scenario/1
trajectory: {kind: city, duration_s: 220, static_s: 20, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 50, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 2, sd_m: [0.01, 0.01, 0.02]}
start_gps: {week: 2374, sow: 208800}
seed: 5
)";

}  // namespace coast::test
