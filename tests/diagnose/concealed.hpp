#pragma once
// Simulated missions in which something is not as the configuration says.

#include <fmt/format.h>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/io/yaml.hpp"
#include "coast/simulate/scenario.hpp"

namespace coast::test {

struct MissionWithTruth {
  diagnose::MissionInput input;
  record::Trajectory truth;
};

/// Of every axis; units of data sheets.
struct WhiteNoiseAndBias {
  double gyro_deg_sqrt_h = 0.15, gyro_bias_deg_h = 20.0;
  double accel_ug_sqrt_hz = 60.0, accel_bias_mg = 2.0;
};
inline noise::ImuErrorModel error_model(const WhiteNoiseAndBias& of) {
  return noise::ImuErrorModel::from(
      io::parse_yaml(fmt::format(R"(
schema: coast.imu_error_model/1
sensor: test
gyro:
  all: [{{process: white_noise, density: {}, unit: deg/sqrt(h)}}, {{process: random_constant, sigma: {}, unit: deg/h}}]
accel:
  all: [{{process: white_noise, density: {}, unit: ug/sqrt(Hz)}}, {{process: random_constant, sigma: {}, unit: mg}}]
)",
                                 of.gyro_deg_sqrt_h, of.gyro_bias_deg_h, of.accel_ug_sqrt_hz, of.accel_bias_mg),
                     "model.yaml"));
}

/// A short drive with an industrial IMU that errs by its own model, GNSS at the antenna twice a second.
inline MissionWithTruth honest_mission_with_truth(std::uint64_t seed, double duration_s = 300.0) {
  simulate::Scenario scenario = simulate::Scenario::from(io::parse_yaml(fmt::format(R"(
schema: coast.scenario/1
trajectory: {{kind: city, duration_s: {}, static_s: 20, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}}
imu: {{rate_hz: 50, lever_arm_m: [0.3, -0.2, -1.1]}}
gnss: {{rate_hz: 2, phase_s: 0.013, sd_m: [0.01, 0.01, 0.02], velocity_sd_mps: [0.03, 0.03, 0.05]}}
start_gps: {{week: 2374, sow: 208800}}
)",
                                                                                    duration_s),
                                                                        "scenario.yaml"),
                                                         [](const std::filesystem::path& file) { return io::load_yaml(file); });
  scenario.error_model = error_model({});
  scenario.seed = seed;
  simulate::SimulatedMission recorded = simulate::simulate(scenario);
  diagnose::MissionInput input{std::move(recorded.imu), std::move(recorded.gnss), {}};
  input.setup.model = *scenario.error_model;
  input.setup.lever_arm_b = scenario.gnss.lever_arm_b;
  return {std::move(input), std::move(recorded.truth)};
}
inline diagnose::MissionInput honest_mission(std::uint64_t seed, double duration_s = 300.0) {
  return honest_mission_with_truth(seed, duration_s).input;
}

inline const diagnose::DiagnosisOptions kWithoutTwins{.twins = 0};

/// The one effect found, by name and axis; nothing where there are more or others.
inline const diagnose::Finding* only(const diagnose::Diagnosis& d, std::string_view name, std::string_view axis) {
  if (d.findings.size() != 1) return nullptr;
  const diagnose::Finding& f = d.findings.front();
  return f.hypothesis.effect->name == name && f.hypothesis.axis_name() == axis ? &f : nullptr;
}

/// What was found, for messages.
inline std::string names(const diagnose::Diagnosis& d) {
  std::string text;
  for (const diagnose::Finding& f : d.findings)
    text += fmt::format("{} {} {} {} +- {}; ", f.hypothesis.effect->name, f.hypothesis.axis_name(),
                        f.hypothesis.effect->equation, f.value, f.sd);
  for (const diagnose::NoiseFinding& f : d.noise)
    text += fmt::format("{} {} {} {} +- {}; ", f.name, f.sensor, f.axis, f.value, f.sd);
  return text;
}

}  // namespace coast::test
