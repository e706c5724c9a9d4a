#pragma once
// run.yaml, read and checked before any data are read, and its recordings. For the jobs process, outage and diagnose.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/diagnose/correction.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/io/aid.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/imu.hpp"
#include "coast/io/projection.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/time_marks.hpp"
#include "coast/jobs/job.hpp"
#include "coast/jobs/ppk.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/imu_calibration.hpp"
#include "coast/record/time_mark.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/study/marked_states.hpp"
#include "coast/study/mission.hpp"
#include "coast/study/outage.hpp"

namespace coast::jobs {

/// A start given by the user; its week comes from the recordings.
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
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  ///< from the IMU to the reference point of the trajectory, m
  std::shared_ptr<io::Projection> projection;         ///< of trajectory.grid.csv, of events and of the page; null: none
};

/// An aiding sensor of the run: where its samples are, and what they measure.
struct AidConfig {
  std::string name;
  io::AidFileOptions file;
  std::shared_ptr<const estimate::Aid> aid;
};

/// Instants at which the state of a device on the body is wanted, such as the exposures of a camera.
struct EventOptions {
  io::TimeMarkFileOptions file;
  bool imu_clock = false;  ///< times are those of the IMU's clock; else of GNSS, which differs by the time offset of the fixes
  double delay_s = 0.0;    ///< from the stated time to the instant that is meant
  study::Mounted camera;
};

struct RunConfig {
  config::Node root;
  std::filesystem::path file;
  io::ImuFileOptions imu;
  std::string imu_name;                               ///< which device it was, for statistics of several; empty: not stated
  std::string imu_serial;                             ///< likewise
  std::optional<record::ImuCalibration> calibration;  ///< taken out of the recording as it is read
  std::optional<std::filesystem::path> noise_levels;  ///< of the IMU over time
  std::optional<std::filesystem::path> members;       ///< measurements of each member of a synthetic IMU
  io::GnssFileOptions gnss;
  std::optional<PpkConfig> ppk;  ///< instead of a file of positions
  bool tight = false;            ///< the filter uses its observations instead of its positions
  std::optional<io::ReferenceFileOptions> reference;
  Eigen::Vector3d reference_lever_arm_b = Eigen::Vector3d::Zero();
  study::Setup setup;
  std::optional<GivenStart> start;
  std::vector<diagnose::NamedEffect> effects;  ///< corrected in the recordings before anything else
  std::vector<AidConfig> aids;
  std::vector<OutageSeconds> outages;
  std::optional<study::OutageSweep> sweep;
  int passes = 1;  ///< odd: forward, then backward and forward again
  bool smooth = true;
  bool combined = false;  ///< smoothed by combining forward and backward filter
  OutputOptions output;
  std::optional<EventOptions> events;
  bool accept = false;  ///< a result that fails its checks is delivered with exit status 0
};

/// @throws InputError  anything missing, out of range or unknown, with file and line
[[nodiscard]] RunConfig read_run_config(const std::filesystem::path& file);
[[nodiscard]] RunConfig read_run_config(const config::Node& root);

/// Content of all input files of a run.
struct Recordings {
  record::ImuRecording imu;  ///< body axes
  record::GnssRecording gnss;
  std::optional<record::Trajectory> reference;
  std::optional<record::TimeMarkRecording> marks;                ///< each with a name
  std::shared_ptr<const estimate::CarrierObservations> carrier;  ///< for tight coupling
  std::vector<record::AidRecording> aids;                        ///< in the order of the configuration
  std::vector<std::string> inspection;                           ///< how the input was interpreted, sentence by sentence
  std::optional<double> time_shift_s;                            ///< of GNSS relative to IMU, for the best match of turns
  record::Events inspection_events;
};

/// Reads all files; a week that one of them does not state is taken from the other.
/// @throws InputError, NumericalError (if positions are to be computed first)
[[nodiscard]] Recordings load(const RunConfig& config, const Progress& progress);

}  // namespace coast::jobs
