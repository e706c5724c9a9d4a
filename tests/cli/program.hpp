#pragma once
// The program as a user runs it: exit status, messages, files.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace coast::cli {

struct Outcome {
  int status;
  std::string error;  ///< standard error
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline Outcome run(const std::string& arguments, const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / "stderr.txt";
  const std::string command =
      fmt::format("'{}' {} >'{}' 2>'{}'", COAST_PROGRAM, arguments, (folder / "stdout.txt").string(), log.string());
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(log)};
}

inline void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

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

/// Simulates a scenario whose error model is model.yaml. @return the folder of the recording, inside `folder`
inline std::filesystem::path simulated_recording(const std::string& scenario, const std::filesystem::path& folder) {
  write(folder / "scenario.yaml", scenario);
  write(folder / "model.yaml", kTestModel);
  const Outcome outcome =
      run(fmt::format("simulate '{}' --out '{}'", (folder / "scenario.yaml").string(), (folder / "rec").string()), folder);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  return folder / "rec";
}

}  // namespace coast::cli
