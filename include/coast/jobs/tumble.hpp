#pragma once
// Multi-position calibration: one recording of an IMU put down in many poses -> scale, misalignment and bias of its sensors.

#include <filesystem>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/imu.hpp"
#include "coast/jobs/job.hpp"
#include "coast/record/imu.hpp"
#include "coast/tumble/calibration.hpp"
#include "coast/tumble/cover.hpp"

namespace coast::jobs {

/// tumble.yaml of `coast calibrate`.
struct TumbleConfig {
  std::filesystem::path file;
  std::string sensor;  ///< name of the product
  io::ImuFileOptions imu;
  tumble::Options options;
  std::string gravity_from;  ///< one line for people: where gravity's value comes from
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] TumbleConfig read_tumble(const std::filesystem::path& file);
[[nodiscard]] TumbleConfig read_tumble(const config::Node& root);
/// The tumble.yaml of the help page, every line preceded by `indent`.
[[nodiscard]] std::string tumble_example(const std::string& indent);

struct TumbleResult {
  std::string source;
  double rate_hz = 0.0;
  double duration = 0.0;  ///< s
  record::Events events;  ///< of the reader
  tumble::Result calibration;
  std::vector<tumble::Proposal> next;  ///< poses that would add most
};

[[nodiscard]] TumbleResult tumble_calibration(const TumbleConfig& config, const Progress& progress);
/// The same for a recording in memory.
[[nodiscard]] TumbleResult tumble_calibration(const TumbleConfig& config, const record::ImuRecording& sensor,
                                              const Progress& progress);

[[nodiscard]] std::vector<std::string> files_of(const TumbleConfig& config);
/// imu_calibration.yaml (docs/schema/imu_calibration.schema.json), tumble.json (docs/schema/tumble_result.schema.json),
/// report.html.
void write(const TumbleConfig& config, const TumbleResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const TumbleConfig& config, const TumbleResult& result, const std::filesystem::path& folder);

}  // namespace coast::jobs
