#pragma once
// From recordings in body axes to a mission that can be filtered: standstill, noise and start.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "coast/estimate/batch_smoother.hpp"
#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"
#include "coast/estimate/noise_fit.hpp"
#include "coast/ins/alignment.hpp"
#include "coast/study/bias_drift.hpp"

namespace coast::study {

/// Long work tells how far it is: what is being done, and the fraction of it.
using Progress = std::function<void(const char* what, double fraction)>;

/// What the configuration leaves to the data.
struct Unstated {
  estimate::NoiseFitChoice noise{
      .gnss_scale = false, .correlated_gnss = false, .imu_white_noise = false};  ///< fitted where innovations contradict it
  bool time_offset = false;                                                      ///< estimated where the innovations show one
  bool lever_arm = false;  ///< estimated where they show another than the stated one
  double time_offset_seen_s =
      0.0;  ///< as the turns of IMU and GNSS tell it, to 0.05 s; taken where the filter finds it likelier
};

/// How a mission is processed; filled from run.yaml.
struct Setup {
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;
  bool high_order_compensation = false;
  noise::ImuErrorModel model;
  estimate::FilterOptions filter;
  bool vehicle_forward = false;            ///< the body points where the vehicle goes
  std::optional<ins::InitialState> start;  ///< given; otherwise found
  /// Sensor states that a given start begins with, by the layout; empty: what the alignment knows.
  Eigen::VectorXd start_sensor_errors;
  int start_rounds = 4;  ///< at most, of the refinement of a start that was found
  /// Where the first studied outage begins: the start is refined with fixes before it alone, or the outage would look too good.
  std::optional<geo::GpsTime> refine_before;
  /// Noise is fitted to what comes before it, where that is at least 100 s.
  std::optional<geo::GpsTime> fit_before;
  std::optional<estimate::NoiseFitChoice> noise_fit;
  Unstated unstated;
  /// The delivered solution is smoothed as a batch; outages that are swept and starts that are refined are not.
  std::optional<estimate::BatchOptions> batch;
  /// Tight coupling, of the prepared mission alone: it is prepared with the fixes.
  std::shared_ptr<const estimate::CarrierObservations> carrier;
};

/// Which of the two that say where the antenna was at the time of a fix.
struct AntennaChoice {
  bool time_offset = false;
  bool lever_arm = false;
};

/// What the first minutes say of them: differences from what is stated, zero where not estimated.
struct AntennaFit {
  double log_likelihood = 0.0;
  double excess = 1.0;  ///< squared innovations over their expectation, at least 1; the sigmas are widened by it
  double time_offset_s = 0.0;
  double time_offset_sd_s = 0.0;
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_arm_sd_m = Eigen::Vector3d::Zero();
};

/// A mission in body axes, aligned. Owns its recordings.
class PreparedMission {
 public:
  /// Compensates, finds standstill, aligns, tests what the setup leaves unstated, fits the noise where the setup asks for it or
  /// the innovations contradict it, and refines the start: from where
  /// alignment succeeded the filter runs back to the first epoch, then the first minutes are smoothed and the start taken from
  /// there until it rests. A given start is taken as it is.
  /// @throws InputError  IMU and GNSS do not overlap in time  @throws NumericalError  the alignment fails
  PreparedMission(record::ImuRecording imu, record::GnssRecording gnss, Setup setup, const Progress& progress);
  PreparedMission(const PreparedMission&) = delete;
  PreparedMission& operator=(const PreparedMission&) = delete;

  [[nodiscard]] const estimate::Mission& mission() const { return *mission_; }
  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] const noise::ImuErrorModel& model() const { return setup_.model; }
  [[nodiscard]] const estimate::FilterOptions& options() const { return setup_.filter; }
  [[nodiscard]] const ins::InitialState& start() const { return start_; }
  [[nodiscard]] const std::optional<estimate::NoiseFit>& noise_fit() const { return noise_fit_; }
  /// What was taken in place of what the setup leaves unstated, an event each.
  [[nodiscard]] const record::Events& adaptations() const { return adaptations_; }
  /// Whether the error model is without what is multiplied by a signal, unlike that of the setup.
  [[nodiscard]] bool gain_errors_left_out() const { return gain_errors_left_out_; }
  /// By how much biases drift more than the setup's error model says.
  [[nodiscard]] const DriftFactors& drift() const { return drift_; }
  /// The heading rests on the assumption that the body's x axis points where the vehicle goes.
  [[nodiscard]] bool heading_assumed() const { return heading_assumed_; }
  /// The start for a filter of any layout.
  [[nodiscard]] estimate::FilterState start_state(const estimate::ForwardFilter& filter) const;
  /// Takes noise as fitted from here on.
  void adopt(const estimate::NoiseFit& fit);
  /// Fits noise over at most the first `longest_s` seconds, the search beginning at `from`.
  [[nodiscard]] estimate::NoiseFit fit(const estimate::NoiseFitChoice& choice, const estimate::NoiseAdjustment& from,
                                       double longest_s, const Progress& progress) const;

  /// What a backward pass begins with that is to know nothing of the forward one but where it ended: its states, with the
  /// uncertainty of the start.
  [[nodiscard]] estimate::FilterState far_end(const estimate::FilterState& last) const;
  /// The same for a backward filter that is to be weighed against the forward one: nothing may count twice that the forward
  /// filter has found. Navigation states ten times as uncertain as there, so that a hundredth of that information counts twice;
  /// sensor states as uncertain as the error model alone leaves them by then; auxiliary states at their prior.
  [[nodiscard]] estimate::FilterState ignorant_end(const estimate::FilterState& last) const;
  /// Filters backward from `from` at the far end to the epoch of the start; delivers states in forward time (from last to
  /// first) before each knot's updates. The recordings are reversed in place meanwhile.
  /// @return the state at the start's epoch, its updates done
  estimate::FilterState run_backward(const estimate::FilterOptions& options, const estimate::FilterState& from,
                                     const std::function<void(const estimate::FilterState&)>& at_knots,
                                     const Progress& progress);

 private:
  static constexpr double kFirstMinutes = 300.0;  ///< s that the start is refined over

  void find_standstill();
  void align(const Progress& progress);
  void run_back_to_first_epoch();
  void refine_start(const Progress& progress);
  void refine_antenna(const Progress& progress);
  void fit_and_adopt(const Progress& progress);
  void choose_time_offset(const Progress& progress);
  void take_out_velocity_lag();
  [[nodiscard]] AntennaChoice antenna_to_test() const;
  [[nodiscard]] bool antenna_is_estimated() const;
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
  /// Filters so many seconds from the start, also those that a studied outage withholds later: what is sought there is
  /// constant, a few numbers from hundreds of fixes.
  [[nodiscard]] estimate::FilterResult first_seconds(double seconds, const estimate::FilterOptions& options,
                                                     const estimate::FilterOutputs& outputs = {}) const;
  [[nodiscard]] double fix_interval_s() const;  ///< mean

  record::ImuRecording imu_;
  record::GnssRecording gnss_;
  Setup setup_;
  std::unique_ptr<estimate::Mission> mission_;
  ins::InitialState start_;
  Eigen::VectorXd start_sensor_errors_;  ///< estimated, by the layout of the setup; empty: zero
  estimate::KnotStore first_knots_;      ///< of the first minutes; one for all passes of the preparation, and empty after it
  std::optional<estimate::NoiseFit> noise_fit_;
  std::optional<double> noise_ratio_;  ///< squared innovations over their expectation, where that had the noise fitted
  std::optional<double> velocity_lag_;
  AntennaChoice tested_;  ///< which the configuration leaves to the data
  Eigen::Vector3d lever_arm_sd_ = Eigen::Vector3d::Zero();
  bool gain_errors_left_out_ = false;
  bool heading_assumed_ = false;
  DriftFactors drift_;
  record::Events adaptations_;
};

}  // namespace coast::study
