#pragma once
// IMU + GNSS -> forward filter -> smoother -> trajectory, with all statistics and checks of the run.

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/jobs/run_file.hpp"
#include "coast/record/event.hpp"
#include "coast/report/series.hpp"
#include "coast/study/causes.hpp"
#include "coast/study/comparison.hpp"
#include "coast/study/marked_states.hpp"
#include "coast/study/outage.hpp"
#include "coast/study/solution.hpp"

namespace coast::jobs {

enum class Standing { kGood, kDoubtful, kUnusable };
[[nodiscard]] const char* name(Standing standing);

/// A check of a number that should be small.
struct Check {
  std::string name;
  double value = 0.0;
  double good = 0.0;                  ///< good up to this value
  std::optional<double> usable = {};  ///< usable up to this value; absent: this check alone does not make a result unusable
  std::string text = {};              ///< the finding, in words
  [[nodiscard]] Standing standing() const;
};

struct Judgement {
  std::vector<Check> checks;
  std::string likely_cause = {};          ///< a sentence; empty if nothing failed or no cause was found
  std::vector<study::Cause> causes = {};  ///< by likelihood, the likeliest first
  bool accepted = false;                  ///< by the configuration
  [[nodiscard]] Standing standing() const;
  /// Whether every check that fails names its cause itself, jumps of GNSS or refused aids, so that no mistake in the treatment
  /// of IMU and fixes is to be sought.
  [[nodiscard]] bool names_its_cause() const;
  /// One line: "good: .." or the failed checks and the likely cause.
  [[nodiscard]] std::string line() const;
};

/// Forward minus backward filter at one knot.
struct Separation {
  geo::GpsTime t;
  Eigen::Vector3d position_n;   ///< N, E, D, m
  Eigen::Vector3d attitude;     ///< roll, pitch, yaw, rad
  Eigen::Vector3d sd_position;  ///< of the difference, if both are independent
  Eigen::Vector3d sd_attitude;
};

/// Estimated sensor and auxiliary states over time, at knots.
struct StateTrack {
  std::string name;             ///< as in StateLayout
  std::vector<double> seconds;  ///< since the start of the mission
  std::vector<double> forward, forward_sd;
  std::vector<double> smoothed, smoothed_sd;
};

/// Errors of one solution relative to the reference: statistics, and curves over seconds since the start.
class ReferenceErrors {
 public:
  /// One error vector, axis by axis, SI and rad.
  using Curves = std::array<report::Decimator, 3>;

  explicit ReferenceErrors(geo::GpsTime start);
  void add(const study::ErrorSample& sample);
  [[nodiscard]] const study::ErrorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const Curves& position() const { return position_; }  ///< band: one predicted sigma around zero
  [[nodiscard]] const Curves& velocity() const { return velocity_; }
  [[nodiscard]] const Curves& attitude() const { return attitude_; }  ///< band as for the position

 private:
  geo::GpsTime start_;
  study::ErrorStatistics statistics_;
  Curves position_;
  Curves velocity_;
  Curves attitude_;
};

struct AgainstReference {
  ReferenceErrors forward;
  std::optional<ReferenceErrors> smoothed;
  bool has_velocity = false;
  bool has_attitude = false;
  [[nodiscard]] study::ErrorSummary summary(const ReferenceErrors& errors) const {
    return errors.statistics().summary(has_velocity, has_attitude);
  }
};

/// Normalised innovations squared of the GNSS updates, by epoch.
struct NisSummary {
  double mean = 0.0;
  double expected = 0.0;  ///< mean degrees of freedom
  std::size_t epochs = 0;
};

/// An aiding sensor in the solution.
struct AidUse {
  std::string name;
  std::size_t used = 0;
  std::size_t refused = 0;
  NisSummary nis;  ///< of the samples that were used
};

/// Errors of the IMU that do not depend on its signals, at the end of the mission, where forward and smoothed solution are one:
/// the sum of the states of each axis, in the sensor's axes.
struct SensorBiases {
  Eigen::Vector3d gyro, gyro_sd;    ///< rad/s
  Eigen::Vector3d accel, accel_sd;  ///< m/s^2
};

/// Curves of the streamed trajectories, decimated while streaming.
class TrajectoryCurves {
 public:
  /// @param start  origin of the local N, E, D frame and zero of the time axes
  explicit TrajectoryCurves(const record::NavState& start);
  ~TrajectoryCurves();
  void add_forward(const record::TrajectoryEpoch& epoch);
  void add_smoothed(const record::TrajectoryEpoch& epoch);

  struct Curves;
  [[nodiscard]] const Curves& curves() const { return *curves_; }

 private:
  std::unique_ptr<Curves> curves_;
};

/// The projection of a run at the start of its mission.
struct ProjectedStart {
  io::GridPosition place;
  double convergence = 0.0;  ///< rad
  io::GridScale scale;
};

/// Events of the run file in the delivered trajectory.
struct EventResults {
  std::vector<record::MarkedState> states;
  std::vector<study::MissedMark> missed;
  std::optional<study::DelayEstimate> delay;  ///< if positions stand beside the times
};

/// Results of a run. The trajectory itself goes to sinks, epoch by epoch: ten hours at 200 Hz need not be in memory.
struct ProcessResult {
  geo::GpsTime start;
  geo::GpsTime end;
  std::size_t imu_samples = 0;
  double imu_rate_hz = 0.0;
  long imu_gaps = 0;
  std::size_t gnss_epochs = 0;  ///< within the mission
  std::size_t gnss_used = 0;
  std::size_t gnss_rejected = 0;
  std::vector<std::pair<record::FixQuality, std::size_t>> qualities;  ///< epochs by quality
  double time_offset_s = 0.0;                                         ///< time offset of the fixes, as used
  std::optional<double> time_offset_sd_s;                             ///< if it was estimated
  std::vector<std::string> files;                                     ///< of the trajectory
  std::vector<std::string> inspection;                                ///< how the input was interpreted, sentence by sentence
  std::string alignment;
  NisSummary nis;
  std::vector<AidUse> aids;
  double smallest_refusable_m = 0.0;  ///< median: the gate cannot detect a smaller horizontal error
  std::vector<estimate::InnovationRecord> innovations;
  std::optional<AgainstReference> reference;
  std::string compared_with;                 ///< of the outages: "reference" or "gap_free_run"
  std::vector<study::OutageResult> outages;  ///< withheld in the delivered trajectory
  std::vector<study::OutageResult> sweep;    ///< each run separately
  std::optional<study::LeverArmCheck> lever_arm;
  Eigen::Vector3d lever_arm_used_b = Eigen::Vector3d::Zero();  ///< as used at the end of the mission, m
  std::optional<Eigen::Vector3d> lever_arm_sd_m;               ///< if it was estimated
  SensorBiases biases;
  std::optional<EventResults> marked;
  std::shared_ptr<const io::Projection> projection;  ///< null: none was asked for
  std::optional<ProjectedStart> projected_start;
  std::vector<Separation> separations;
  std::optional<estimate::NoiseFit> noise_fit;
  std::vector<StateTrack> states;
  std::optional<estimate::BatchReport> batch;
  Judgement verdict;
  std::vector<estimate::GnssJump> jumps;
  record::Events events;
  study::Setup used;                   ///< as given, with fitted, estimated or adapted values
  std::vector<record::GnssFix> fixes;  ///< as used: without gross errors, with delayed velocities shifted in time
  std::shared_ptr<const TrajectoryCurves> curves;
  std::string resolved;  ///< the configuration with every value used: gives the same numbers again
};

/// Receive the trajectories of the IMU, epoch by epoch in time order, at IMU epochs. Each is called by one thread at a time,
/// but the two by different threads. Either may be empty.
struct TrajectorySinks {
  record::EpochSink forward;
  record::EpochSink delivered;  ///< smoothed or combined; forward if the configuration has no smoother
};

/// @param recordings  load(config), or filled in memory
/// @throws InputError    recordings that do not overlap in time, an outage outside of them
/// @throws NumericalError  no start is found (with the likeliest cause); axes that contradict gravity
[[nodiscard]] ProcessResult process(const RunConfig& config, Recordings recordings, const TrajectorySinks& sinks,
                                    const Progress& progress);

/// A result with its trajectories, at the rate and for the point set by `output` of the configuration.
struct ProcessedMission {
  ProcessResult result;
  std::vector<record::TrajectoryEpoch> forward;
  std::vector<record::TrajectoryEpoch> delivered;
};
/// Everything in memory: some 500 bytes per epoch.
/// @param also  receive the epochs of the IMU too, for files
[[nodiscard]] ProcessedMission process(const RunConfig& config, Recordings recordings, const Progress& progress,
                                       const TrajectorySinks& also = {});

[[nodiscard]] std::vector<std::string> files_of(const RunConfig& config);

/// The files of the trajectories, written during the computation. A file that is not closed does not appear.
class TrajectoryFiles {
 public:
  TrajectoryFiles(const RunConfig& config, const std::filesystem::path& folder);
  ~TrajectoryFiles();
  TrajectoryFiles(const TrajectoryFiles&) = delete;
  TrajectoryFiles& operator=(const TrajectoryFiles&) = delete;
  [[nodiscard]] TrajectorySinks sinks();
  /// From here until write(), the folder contains results of two runs. @throws OutputError
  void close();

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

/// summary.json, innovations.csv, run.resolved.yaml, report.html; with events events.csv, events_opk.csv, geo.txt.
void write(const RunConfig& config, const ProcessResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const RunConfig& config, const ProcessResult& result, const std::filesystem::path& folder);
/// @throws NumericalError  the result contradicts its input, and the configuration does not accept that
void require_usable(const RunConfig& config, const ProcessResult& result);

}  // namespace coast::jobs
