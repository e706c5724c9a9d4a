#pragma once
// A scenario file: a motion with an IMU and a GNSS receiver; and the simulated recording.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/simulate/aids.hpp"
#include "coast/simulate/gnss.hpp"
#include "coast/simulate/imu.hpp"
#include "coast/simulate/motions.hpp"
#include "coast/simulate/observations.hpp"

namespace coast::simulate {

/// Reads a file named in the scenario into a tree (io::load_yaml).
using TreeReader = std::function<config::Node(const std::filesystem::path&)>;

/// A GNSS outage to be studied when the recording is processed: the fixes stay in the recording.
struct StudiedOutage {
  geo::GpsTime start;
  double duration = 0.0;  ///< s
};

/// scenario.yaml (schema coast.scenario/1). Times are seconds since the start of the mission.
///
///     schema: coast.scenario/1
///     trajectory: {kind: car_roundabout, duration_s: 900, static_s: 60, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
///     imu:
///       rate_hz: 100
///       error_model: ../imu/fsas-em.yaml       # left out: an error-free IMU
///       lever_arm_m: [0.3, -0.2, -1.1]         # IMU to antenna; forward, right, down
///       axes: [x, y, z]                        # body forward, right, down in terms of sensor axes
///       mounting_deg: [0, 0, 0]                # roll, pitch, yaw of the rotation that takes body to sensor, after `axes`
///     gnss:
///       rate_hz: 10
///       phase_s: 0.0
///       sd_m: [0.01, 0.01, 0.02]               # white; north, east, down
///       correlated: {sd_m: [0.01, 0.01, 0.02], correlation_time_s: 120}
///       stated_sd_m: [0.01, 0.01, 0.02]        # left out: white and correlated together
///       velocity_sd_mps: [0.02, 0.02, 0.04]    # left out: no velocities
///       time_offset_s: 0.0                     # a fix tagged t is valid at t - time_offset_s
///       gaps: [{elapsed_s: 300, duration_s: 20}]
///       observations:                          # left out: positions only; else codes and phases of rover and base (RINEX) too
///         systems: [gps, galileo]              # of gps, glonass, galileo, beidou
///         rate_hz: 1                           # of the rover; base_rate_hz of the base
///         base_ned_m: [3000, 1000, 0]          # the base from the trajectory's origin
///         obstacles: [{elapsed_s: 300, duration_s: 60, azimuth_deg: [60, 200], below_deg: 50}]
///         slips_per_hour: 4                    # of each phase; and code_sd_m, phase_sd_m, code_multipath_sd_m, ...
///       degraded: [{elapsed_s: 500, duration_s: 30, quality: float, sd_factor: 30, stated_sd_factor: 10}]
///     array:                                   # left out: one IMU; else further ones on the same body, with their own noise
///       - {name: left, error_model: ../imu/xsens-dot.yaml, position_m: [0.1, -0.1, 0], axes: [x, y, z],
///          mounting_deg: [0, 0, 0], clock_offset_s: 0.004, clock_drift_ppm: 20}   # tag = true time + offset + drift * elapsed
///     aids: []                                 # aiding sensors, see AidOptions
///     outages: [{manoeuvre: roundabout, duration_s: 20}, {elapsed_s: 500, duration_s: 60}]   # for the run to study
///     start_gps: {week: 2374, sow: 208800}
///     seed: 1
struct Scenario {
  std::string kind;
  MotionParameters motion;
  double imu_rate_hz = 100.0;
  std::optional<std::filesystem::path> error_model_file;
  std::optional<noise::ImuErrorModel> error_model;
  ins::MountingOptions mounting;
  GnssOptions gnss;
  std::optional<ObservationOptions> observations;
  /// One IMU of an array on the scenario's body.
  struct ArrayImu {
    std::string name;
    noise::ImuErrorModel error_model;
    ins::MountingOptions mounting;
    Eigen::Vector3d position_b = Eigen::Vector3d::Zero();  ///< m, from the body's point
    double clock_offset = 0.0;                             ///< s
    double clock_drift_ppm = 0.0;
  };
  std::vector<ArrayImu> array;
  std::vector<AidOptions> aids;
  /// An outage of a scenario: at a time, or at the first manoeuvre of a name.
  struct Outage {
    std::string manoeuvre;           ///< empty if the time is given
    double elapsed = 0.0;            ///< s since the start of the mission, or since the start of the manoeuvre
    std::optional<double> duration;  ///< s; if absent, as long as the manoeuvre
  };
  std::vector<Outage> outages;
  geo::GpsTime start;
  std::uint64_t seed = 1;

  /// @throws InputError  anything that cannot be simulated, with file and line; unknown keys with the nearest known one
  [[nodiscard]] static Scenario from(const config::Node& root, const TreeReader& read);
};

/// The simulated recordings of the scenario's vehicle, and its true trajectory.
struct SimulatedMission {
  record::ImuRecording imu;  ///< sensor axes
  record::GnssRecording gnss;
  record::Trajectory truth;  ///< of the IMU, at the start and at every IMU epoch
  std::vector<StudiedOutage> outages;
};

/// The scenario's outages as times on its motion, in the order given.
/// @throws InputError  a manoeuvre does not occur in the motion (lists those that do)
[[nodiscard]] std::vector<StudiedOutage> studied_outages(const Scenario& scenario, const MotionPlan& plan);

/// The part of a scenario that does not depend on the seed (motion, error-free increments, true states), computed once for many
/// seeds.
class ErrorFreeMission {
 public:
  /// @param threads  at least 1; the result is bitwise the same for any number
  /// @throws InputError  as `studied_outages`
  explicit ErrorFreeMission(const Scenario& scenario, int threads = 1);

  struct Recordings {
    record::ImuRecording imu;  ///< sensor axes
    record::GnssRecording gnss;
  };
  /// Simulated recordings. May be called from several threads at the same time.
  /// @param model  absent: an error-free IMU  @param seed  instead of the scenario's
  [[nodiscard]] Recordings recorded(const std::optional<noise::ImuErrorModel>& model, std::uint64_t seed) const;

  [[nodiscard]] const record::Trajectory& truth() const { return truth_; }
  [[nodiscard]] const std::vector<StudiedOutage>& outages() const { return outages_; }

 private:
  AnalyticTrajectory motion_;
  geo::GpsTime start_;
  GnssOptions gnss_;
  std::vector<StudiedOutage> outages_;
  record::ImuRecording increments_;
  record::Trajectory truth_;
};

/// Simulated recording of an IMU of the scenario's array, in its own axes and by its own clock.
/// @param index  index in `scenario.array`; its noise has its own seeds
[[nodiscard]] record::ImuRecording simulate_array_imu(const Scenario& scenario, std::size_t index, int threads = 1);

/// One recording: the scenario's error model, the scenario's seed.
/// @param threads  at least 1; the result is bitwise the same for any number
/// @throws InputError  as `studied_outages`
[[nodiscard]] SimulatedMission simulate(const Scenario& scenario, int threads = 1);

}  // namespace coast::simulate
