#include "bench/mission.hpp"

#include <fmt/format.h>

#include <map>

#include "coast/io/yaml.hpp"

namespace coast::bench {

namespace {

constexpr const char* kScenario = R"(
schema: coast.scenario/1
trajectory: {{kind: {}, duration_s: {}, static_s: 60, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}}
imu: {{rate_hz: {}, lever_arm_m: [0.3, -0.2, -1.1], error_model: model.yaml}}
gnss: {{rate_hz: {}, sd_m: [0.01, 0.01, 0.02]}}
start_gps: {{week: 2374, sow: 208800}}
seed: 1
)";

constexpr const char* kModel21 = R"(
schema: coast.imu_error_model/1
sensor: industrial MEMS
rate_hz: 200
gyro:
  all:
    - {process: white_noise, density: 0.1, unit: deg/sqrt(h)}
    - {process: gauss_markov, sigma: 25, unit: deg/h, correlation_time_s: 3600}
    - {process: scale_factor, sigma: 300, unit: ppm, correlation_time_s: 3600}
accel:
  all:
    - {process: white_noise, density: 0.1, unit: m/s/sqrt(h)}
    - {process: gauss_markov, sigma: 200, unit: mGal, correlation_time_s: 3600}
    - {process: scale_factor, sigma: 300, unit: ppm, correlation_time_s: 3600}
)";

constexpr const char* kMore = R"(
    - {process: misalignment, sigma: 0.3, unit: mrad}
)";

constexpr const char* kSecondProcess = R"(
    - {process: gauss_markov, sigma: 20, unit: mGal, correlation_time_s: 60}
)";

noise::ImuErrorModel parsed(const std::string& text) {
  return noise::ImuErrorModel::from(io::parse_yaml(text, "model.yaml"));
}

/// Each scenario once.
const simulate::SimulatedMission& simulated(const std::string& scenario) {
  static std::map<std::string, simulate::SimulatedMission> missions;
  const auto known = missions.find(scenario);
  if (known != missions.end()) return known->second;
  const auto read = [](const std::filesystem::path& path) { return io::parse_yaml(kModel21, path.string()); };
  const config::Node root = io::parse_yaml(scenario, "scenario.yaml");
  return missions.emplace(scenario, simulate::simulate(simulate::Scenario::from(root, read))).first->second;
}

}  // namespace

const simulate::SimulatedMission& car_mission(int gnss_rate_hz) {
  return simulated(fmt::format(kScenario, "car_roundabout", 600, 200, gnss_rate_hz));
}

const simulate::SimulatedMission& city_mission(int seconds) {
  return simulated(fmt::format(kScenario, "city", seconds, 100, 1));
}

Eigen::Vector3d lever_arm() {
  return {0.3, -0.2, -1.1};
}

noise::ImuErrorModel model_21() {
  return parsed(kModel21);
}

noise::ImuErrorModel model_36() {
  std::string text = kModel21;
  const std::size_t accel = text.find("accel:");
  text.insert(accel, kMore + 1);  // the literal's own first line break is left out
  text.append(kMore + 1).append(kSecondProcess + 1);
  return parsed(text);
}

}  // namespace coast::bench
