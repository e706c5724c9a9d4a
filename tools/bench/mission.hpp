#pragma once
// The missions that the benchmarks work on: simulated once, kept in memory.

#include "coast/estimate/forward_filter.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/simulate/scenario.hpp"

namespace coast::bench {

/// Ten minutes of a car at 200 Hz with an industrial MEMS IMU and cm-level fixes at `gnss_rate_hz` (1 or 10).
[[nodiscard]] const simulate::SimulatedMission& car_mission(int gnss_rate_hz);

/// A car in a city, with the same IMU at 100 Hz and fixes at 1 Hz.
[[nodiscard]] const simulate::SimulatedMission& city_mission(int seconds);

/// Lever arm from IMU to antenna of these cars, m.
[[nodiscard]] Eigen::Vector3d lever_arm();

/// 21 states: bias and scale factor of every axis, first-order Gauss-Markov.
[[nodiscard]] noise::ImuErrorModel model_21();
/// 36 states: two Gauss-Markov processes, scale factor and two misalignments of each accelerometer, one process less of each
/// gyro; with lever arm and time offset 40.
[[nodiscard]] noise::ImuErrorModel model_36();

}  // namespace coast::bench
