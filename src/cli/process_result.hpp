#pragma once
// Everything that a run of `coast process` found out; summary.json and the page are made of it.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/event.hpp"
#include "coast/report/series.hpp"
#include "coast/study/comparison.hpp"
#include "coast/study/outage.hpp"
#include "coast/study/solution.hpp"
#include "verdict.hpp"

namespace coast::cli {

/// Forward minus backward filter at one knot.
struct Separation {
  geo::GpsTime t;
  Eigen::Vector3d position_n;   ///< N, E, D, m
  Eigen::Vector3d attitude;     ///< roll, pitch, yaw, rad
  Eigen::Vector3d sd_position;  ///< of the difference were both independent
  Eigen::Vector3d sd_attitude;
};

/// Estimated sensor and auxiliary states over time, at knots.
struct StateTrack {
  std::string name;             ///< as in StateLayout
  std::vector<double> seconds;  ///< since the start of the mission
  std::vector<double> forward, forward_sd;
  std::vector<double> smoothed, smoothed_sd;
};

/// Errors of one solution against the reference: summed up, and as curves over seconds since the start.
class ReferenceErrors {
 public:
  /// One vector of the errors, axis by axis, SI and rad.
  using Curves = std::array<report::Decimator, 3>;

  explicit ReferenceErrors(geo::GpsTime start);
  void add(const study::ErrorSample& sample);
  [[nodiscard]] const study::ErrorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const Curves& position() const { return position_; }  ///< band: one predicted sigma around zero
  [[nodiscard]] const Curves& velocity() const { return velocity_; }
  [[nodiscard]] const Curves& attitude() const { return attitude_; }  ///< band as of the position

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
  double time_offset_s = 0.0;                                         ///< of the fixes' tags, as used
  std::optional<double> time_offset_sd_s;                             ///< where it was estimated
  std::vector<std::string> files;                                     ///< of the trajectory
  std::vector<std::string> inspection;  ///< what was understood of the input, sentence by sentence
  std::string alignment;
  NisSummary nis;
  double smallest_refusable_m = 0.0;  ///< median: a horizontal error below it the gate cannot see
  std::vector<estimate::InnovationRecord> innovations;
  std::optional<AgainstReference> reference;
  std::string compared_with;                 ///< of the outages: "reference" or "gap_free_run"
  std::vector<study::OutageResult> outages;  ///< withheld in the delivered trajectory
  std::vector<study::OutageResult> sweep;    ///< each run by itself
  std::optional<study::LeverArmCheck> lever_arm;
  std::vector<Separation> separations;
  std::optional<estimate::NoiseFit> noise_fit;
  std::vector<StateTrack> states;
  std::optional<estimate::BatchReport> batch;
  Judgement verdict;
  std::vector<estimate::GnssJump> jumps;
  record::Events events;
};

[[nodiscard]] NisSummary nis_of(const std::vector<estimate::InnovationRecord>& innovations);

}  // namespace coast::cli
