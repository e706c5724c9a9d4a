#pragma once
// Prepares recordings in body axes for the filter: standstill, noise and start.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "coast/estimate/batch_smoother.hpp"
#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"
#include "coast/estimate/noise_fit.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/alignment.hpp"
#include "coast/study/bias_drift.hpp"

namespace coast::study {

/// Progress of long computations: the current step, and the fraction of it that is done.
using Progress = std::function<void(const char* what, double fraction)>;

/// Parameters that the configuration leaves to be determined from the data.
struct Unstated {
  estimate::NoiseFitChoice noise{
      .gnss_scale = false, .correlated_gnss = false, .imu_white_noise = false};  ///< fitted if the innovations contradict it
  bool time_offset = false;                                                      ///< estimated if the innovations show one
  bool lever_arm = false;  ///< estimated if they contradict the stated one
  double time_offset_seen_s =
      0.0;  ///< from the turns in IMU and GNSS, to 0.05 s; used if it has a higher likelihood in the filter
};

/// Of a car at rest, unless configured.
inline constexpr double kCarZeroVelocitySd = 0.02;                 ///< m/s
inline constexpr double kCarHeadingHoldSd = 0.002 * geo::kDegree;  ///< rad/sqrt(s)

/// An aiding sensor as recorded.
struct AidSource {
  std::string name;
  std::shared_ptr<const estimate::Aid> aid;
  record::AidRecording rows;
};

/// Time offset and lever arm: the antenna's position at the time of a fix.
struct AntennaPlace {
  double time_offset_s = 0.0;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  bool operator==(const AntennaPlace&) const = default;
};

/// How a mission is processed; filled from run.yaml.
struct Setup {
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;
  bool high_order_compensation = false;
  noise::ImuErrorModel model;
  estimate::FilterOptions filter;
  bool vehicle_forward = false;            ///< body x points in the direction of travel
  std::optional<ins::InitialState> start;  ///< if given; otherwise found by alignment
  /// Sensor states of a given start, in the order of the layout; empty: from the alignment.
  Eigen::VectorXd start_sensor_errors;
  /// Behind long gaps of the IMU, if given; otherwise each is found as the start is, which takes longer than filtering.
  std::optional<std::vector<estimate::Restart>> restarts;
  /// Where the refinement of an estimated antenna begins, if it was found before; the prior remains about the stated values.
  std::optional<AntennaPlace> antenna_found;
  int start_rounds = 4;  ///< maximum number of refinements of a start found by alignment
  /// Start of the first studied outage: the start is refined only with fixes before it, so that outage results are not too
  /// optimistic.
  std::optional<geo::GpsTime> refine_before;
  /// Noise is fitted to the data before this time, if that is at least 100 s.
  std::optional<geo::GpsTime> fit_before;
  std::optional<estimate::NoiseFitChoice> noise_fit;
  Unstated unstated;
  /// The delivered solution uses the batch smoother; swept outages and refined starts do not.
  std::optional<estimate::BatchOptions> batch;
  /// Tight coupling, only of the prepared mission: the preparation uses the fixes.
  std::shared_ptr<const estimate::CarrierObservations> carrier;
  /// Aiding sensors, only of the prepared mission too; constants that they leave open are found from the fixes.
  std::vector<AidSource> aids;
};

/// Selects time offset and lever arm, which together give the antenna position at the time of a fix.
struct AntennaChoice {
  bool time_offset = false;
  bool lever_arm = false;
};

/// Estimates of both from the first minutes: differences from the stated values, zero if not estimated.
struct AntennaFit {
  double log_likelihood = 0.0;
  double excess = 1.0;  ///< squared innovations over their expectation, at least 1; the sigmas are scaled by it
  double time_offset_s = 0.0;
  double time_offset_sd_s = 0.0;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_arm_sd_m = Eigen::Vector3d::Zero();
};

/// A mission in body axes, aligned. Owns its recordings.
class PreparedMission {
 public:
  /// Compensates, finds standstill, aligns, tests the unstated parameters, fits the noise if the setup requests it or the
  /// innovations contradict it, and refines the start: from where alignment succeeded the filter runs back to the first epoch;
  /// then the first minutes are smoothed and the start is set from them until it converges. A given start is used unchanged.
  /// @throws InputError  IMU and GNSS do not overlap in time  @throws NumericalError  the alignment fails
  PreparedMission(record::ImuRecording imu, record::GnssRecording gnss, Setup setup, const Progress& progress);
  PreparedMission(const PreparedMission&) = delete;
  PreparedMission& operator=(const PreparedMission&) = delete;

  [[nodiscard]] const estimate::Mission& mission() const { return *mission_; }
  [[nodiscard]] const Setup& setup() const { return setup_; }
  /// Whether time offset or lever arm are states.
  [[nodiscard]] bool antenna_is_estimated() const;
  [[nodiscard]] const noise::ImuErrorModel& model() const { return setup_.model; }
  [[nodiscard]] const estimate::FilterOptions& options() const { return setup_.filter; }
  [[nodiscard]] const ins::InitialState& start() const { return start_; }
  [[nodiscard]] const std::optional<estimate::NoiseFit>& noise_fit() const { return noise_fit_; }
  /// Values used for parameters that the setup leaves unstated, one event each.
  [[nodiscard]] const record::Events& adaptations() const { return adaptations_; }
  /// Whether errors that multiply a signal (e.g. scale factors) were removed from the error model of the setup.
  [[nodiscard]] bool gain_errors_left_out() const { return gain_errors_left_out_; }
  /// Factors by which biases drift more than in the setup's error model.
  [[nodiscard]] const DriftFactors& drift() const { return drift_; }
  /// Whether the heading relies on the assumption that the body's x axis points in the direction of travel.
  [[nodiscard]] bool heading_assumed() const { return heading_assumed_; }
  /// The start for a filter of any layout.
  [[nodiscard]] estimate::FilterState start_state(const estimate::ForwardFilter& filter) const;
  /// Uses the fitted noise from here on.
  void adopt(const estimate::NoiseFit& fit);
  /// Fits noise over at most the first `longest_s` seconds, the search beginning at `from`.
  [[nodiscard]] estimate::NoiseFit fit(const estimate::NoiseFitChoice& choice, const estimate::NoiseAdjustment& from,
                                       double longest_s, const Progress& progress) const;

  /// Start of a backward pass that uses only the final states of the forward pass: these states, with the uncertainty of the
  /// start.
  [[nodiscard]] estimate::FilterState far_end(const estimate::FilterState& last) const;
  /// Independent end: the same for a backward filter that is combined with the forward one, so that no information of the
  /// forward filter counts twice. Navigation states have ten times the sigmas of `last`, so that a hundredth of that
  /// information counts twice; sensor states have the uncertainty of the error model alone at that time; auxiliary states have
  /// their prior.
  [[nodiscard]] estimate::FilterState ignorant_end(const estimate::FilterState& last) const;
  /// Filters backward from `from` at the end of the mission to the epoch of the start; passes states, in forward time and from
  /// last to first, to `at_knots` before each knot's updates. The recordings are temporarily reversed in place.
  /// @return the state at the start's epoch, after its updates
  estimate::FilterState run_backward(const estimate::FilterOptions& options, const estimate::FilterState& from,
                                     const std::function<void(const estimate::FilterState&)>& at_knots,
                                     const Progress& progress);

 private:
  static constexpr double kFirstMinutes = 300.0;  ///< s over which the start is refined

  void find_standstill();
  void align(const Progress& progress);
  void run_back_to_first_epoch();
  void refine_start(const Progress& progress);
  void refine_antenna(const Progress& progress);
  void fit_and_adopt(const Progress& progress);
  void choose_time_offset(const Progress& progress);
  void take_out_velocity_lag();
  [[nodiscard]] AntennaChoice antenna_to_test() const;
  [[nodiscard]] estimate::FilterState antenna_as_stated(estimate::FilterState state, const estimate::StateLayout& layout) const;
  [[nodiscard]] AntennaFit fit_antenna(AntennaChoice estimated);
  void test_antenna();
  void take_antenna(AntennaChoice shown, const AntennaFit& found);
  void keep_as_stated(AntennaChoice which);
  void free_antenna();
  void test_noise();
  void adapt_drift();
  void note_adaptations();
  void restart_behind_gaps();
  void take_aids();
  /// Filters the first `seconds`, including fixes that a studied outage withholds later: only a few constant parameters are
  /// estimated from hundreds of fixes.
  [[nodiscard]] estimate::FilterResult first_seconds(double seconds, const estimate::FilterOptions& options,
                                                     const estimate::FilterOutputs& outputs = {}) const;
  [[nodiscard]] double fix_interval_s() const;  ///< mean

  record::ImuRecording imu_;
  record::GnssRecording gnss_;
  Setup setup_;
  std::unique_ptr<estimate::Mission> mission_;
  ins::InitialState start_;
  Eigen::VectorXd start_sensor_errors_;  ///< estimated, in the order of the setup's layout; empty: zero
  estimate::KnotStore first_knots_;      ///< of the first minutes; shared by all passes of the preparation, and empty after it
  std::optional<estimate::NoiseFit> noise_fit_;
  std::optional<double> noise_ratio_;  ///< squared innovations over their expectation, if it caused the noise fit
  std::optional<double> velocity_lag_;
  AntennaChoice tested_;  ///< those that the configuration leaves to the data
  Eigen::Vector3d lever_arm_sd_ = Eigen::Vector3d::Zero();
  bool gain_errors_left_out_ = false;
  bool heading_assumed_ = false;
  std::optional<double> heading_hold_sd_;  ///< as configured; not used by the preparation
  DriftFactors drift_;
  record::Events adaptations_;
};

}  // namespace coast::study
