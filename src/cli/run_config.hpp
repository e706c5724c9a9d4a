#pragma once
// run.yaml, read and checked before any data are.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/diagnose/correction.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/reference.hpp"
#include "coast/study/mission.hpp"
#include "coast/study/outage.hpp"
#include "ppk_config.hpp"

namespace coast::cli {

/// A start given by hand; its week comes from the recordings.
struct GivenStart {
  double time_s = 0.0;  ///< seconds of week
  geo::Geodetic position;
  Eigen::Vector3d velocity_n;
  geo::Euler attitude;
  Eigen::Vector3d sd_position_n;
  Eigen::Vector3d sd_velocity_n;
  Eigen::Vector3d sd_attitude_n;
};

struct OutageSeconds {
  double start_s = 0.0;  ///< seconds of week
  double duration_s = 0.0;
  int satellites_left = 0;
};

struct OutputOptions {
  std::optional<double> rate_hz;                      ///< absent: IMU epochs
  std::vector<std::string> formats{"nav", "csv"};     ///< of the trajectory; forward.nav comes with nav
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  ///< IMU to the point that the trajectory refers to, m
};

struct RunConfig {
  config::Node root;
  std::filesystem::path file;
  io::ImuFileOptions imu;
  std::optional<std::filesystem::path> noise_levels;  ///< of the IMU over time
  std::optional<std::filesystem::path> members;       ///< what each member of a synthetic IMU measured
  io::GnssFileOptions gnss;
  std::optional<PpkConfig> ppk;  ///< in place of a file of positions
  bool tight = false;            ///< its observations, in place of its positions, go into the filter
  std::optional<io::ReferenceFileOptions> reference;
  Eigen::Vector3d reference_lever_arm_b = Eigen::Vector3d::Zero();
  study::Setup setup;
  std::optional<GivenStart> start;
  std::vector<diagnose::NamedEffect> effects;  ///< to be taken out of the recordings before anything else
  std::vector<OutageSeconds> outages;
  std::optional<study::OutageSweep> sweep;
  int passes = 1;  ///< odd: forward, then backward and forward again
  bool smooth = true;
  bool combined = false;  ///< smoothed as forward and backward filter combined
  OutputOptions output;
  bool accept = false;  ///< a result that fails its checks is delivered with exit status 0
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] RunConfig read_run_config(const std::filesystem::path& file);

/// [latitude_deg, longitude_deg, height_m]
[[nodiscard]] geo::Geodetic geodetic_from(const config::Node& node);

/// Keys `every_s`, `first_s`, `durations_s` of a swept study; of a run, `satellites` too.
[[nodiscard]] study::OutageSweep sweep_from(const config::Node& node);
[[nodiscard]] study::OutageSweep sweep_from(const config::Node& node, const RunConfig& run);

}  // namespace coast::cli
