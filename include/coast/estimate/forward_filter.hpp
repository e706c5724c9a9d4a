#pragma once
// The closed-loop error-state filter: strapdown from knot to knot, covariance with composed transitions, updates at knots.

#include <functional>
#include <optional>
#include <vector>

#include "coast/estimate/aid.hpp"
#include "coast/estimate/carrier_observations.hpp"
#include "coast/estimate/knot.hpp"
#include "coast/estimate/state_layout.hpp"
#include "coast/estimate/transition.hpp"
#include "coast/estimate/update.hpp"
#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::estimate {

/// A stretch of time [from, to).
struct TimeSpan {
  geo::GpsTime from;
  geo::GpsTime to;
  [[nodiscard]] bool contains(geo::GpsTime t) const { return from <= t && t < to; }
};

/// Period in which GNSS is withheld from the filter. With tight coupling, `satellites_left` satellites of highest elevation
/// remain.
struct Withheld {
  geo::GpsTime from;
  geo::GpsTime to;
  int satellites_left = 0;
  [[nodiscard]] bool contains(geo::GpsTime t) const { return from <= t && t < to; }
};

/// State after a long IMU gap, determined without data from before the gap: the heading may then be arbitrary, and a linear
/// filter does not recover it.
struct Restart {
  record::NavState nav;  ///< replaces the filter's attitude at nav.t, and position and velocity if those are lost
  Eigen::Vector3d sd_position_n;
  Eigen::Vector3d sd_velocity_n;
  std::optional<Eigen::Vector3d> sd_attitude_n;  ///< rotations about N, E, D; absent: the filter's attitude is kept
};

/// Input of the filter. The recordings must outlive the filter.
struct Mission {
  const record::ImuRecording& imu;  ///< body axes
  const record::GnssRecording& gnss;
  ins::IncrementKind increments = ins::IncrementKind::kRaw;
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();  ///< the error model is in sensor axes
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;             ///< a fix tagged t is valid at t - offset
  std::vector<TimeSpan> standstill = {};  ///< in order; used for zero-velocity updates if these are enabled
  double earth_rate = geo::kEarthRate;    ///< negative for a time-reversed recording
  /// Epoch at which known drifts are zero; if absent, the start of the recording.
  std::optional<geo::GpsTime> first_epoch = {};
  /// Tight coupling: used instead of the fixes. Must outlive the filter.
  const CarrierObservations* carrier = nullptr;
  std::vector<Restart> restarts = {};  ///< ascending; each becomes a knot
  std::vector<AidStream> aids = {};    ///< each sample becomes a knot
};

/// Factors on the stated GNSS standard deviations.
struct GnssScale {
  double horizontal = 1.0;
  double vertical = 1.0;
  double velocity = 1.0;
};

/// Constraints on the motion of a vehicle.
struct VehicleConstraints {
  std::optional<NonHolonomic> non_holonomic;
  std::optional<double> zero_velocity_sd_mps;
  std::optional<double> heading_hold_sd;  ///< rad/sqrt(s): random walk of the heading at rest
  double interval_s = 0.5;                ///< at most one of each per interval: slip errors are correlated in time
  double min_speed_mps = 0.2;             ///< below it only zero-velocity updates are used
};

struct FilterOptions {
  AuxiliaryStates auxiliary;
  GnssScale gnss_scale;
  bool use_gnss_velocity = true;
  double gate_probability = 1e-6;  ///< probability that the gate rejects a good fix; 0: no gate
  double gate_patience_s = 3.0;  ///< after fixes have been rejected for longer they are used: then the filter is assumed wrong
  double knot_interval_s = 0.5;  ///< longest interval between knots
  /// Additional instants that become knots, ascending.
  std::vector<geo::GpsTime> knots_at = {};
  VehicleConstraints vehicle;
  std::vector<Withheld> withheld;
};

/// One innovation in axes for display: GNSS in N, E, D; non-holonomic: lateral and vertical in the first two; carrier phases:
/// the resulting change of antenna position; member difference: its axes; heading hold, aids: their components.
struct InnovationRecord {
  geo::GpsTime t;
  UpdateKind kind = UpdateKind::kGnssPosition;
  std::size_t aid = 0;  ///< index in Mission::aids, of kAid
  bool used = true;
  int dof = 3;
  Eigen::Vector3d nu = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();  ///< square roots of the diagonal of S
  double nis = 0.0;
  double largest_sd = 0.0;  ///< square root of the largest eigenvalue of S: the scale of errors that the gate can detect
  record::FixQuality quality = record::FixQuality::kUnknown;
};

/// Identifies a measurement of a mission, so that it can be linearised again.
struct Measurement {
  UpdateKind kind = UpdateKind::kGnssPosition;
  std::size_t index = 0;                        ///< of the fix, of the members' block, or of the aid's sample
  noise::Sensor sensor = noise::Sensor::kGyro;  ///< of a member's difference
  std::size_t member = 0;                       ///< likewise
  std::vector<std::size_t> left_out = {};       ///< likewise: members rejected in this block
  std::size_t aid = 0;                          ///< index in Mission::aids
};

/// A jump: positions that differed from an instant on and were rejected, until the filter accepted them.
struct GnssJump {
  geo::GpsTime t;
  Eigen::Vector3d by_n;  ///< fixes minus filter when they were accepted, north east down, m
};

struct FilterResult {
  FilterState last;
  std::vector<InnovationRecord> innovations;
  double log_likelihood = 0.0;  ///< of the innovations that were used
  std::vector<GnssJump> jumps;
  record::Events events;  ///< `gnss_jump` of each, among others
};

/// Outputs of a pass; every member may be empty.
struct FilterOutputs {
  KnotStore* knots = nullptr;
  /// Each knot as stored in `knots`, with the white noise of its interval; called at the knot that ends the interval.
  std::function<void(const Knot&, const AxisNoise&)> closed_knots = {};
  record::EpochSink epochs;                          ///< filtered state at IMU epochs
  std::function<void(const FilterState&)> at_knots;  ///< before the knot's updates
  /// Every measurement, and whether it was used; called at the next knot. Not for carrier phases and heading hold.
  std::function<void(const Measurement&, bool)> measurements;
  std::function<void(double)> progress;  ///< fraction done
};

class ForwardFilter {
 public:
  /// @throws std::invalid_argument  an option is out of its range
  /// @throws InputError  members that differ from those of the error model, or that have no white noise in it
  ForwardFilter(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options);

  [[nodiscard]] const StateLayout& layout() const { return layout_; }
  /// Initial state and covariance: navigation standard deviations in N, E, D, the rest from the error model. Sensor states have
  /// the prior means of the model, propagated to nav.t.
  [[nodiscard]] FilterState initial_state(const record::NavState& nav, const Eigen::Vector3d& sd_position_n,
                                          const Eigen::Vector3d& sd_velocity_n, const Eigen::Vector3d& sd_attitude_n) const;

  /// Filters from the start state to the end of the recording.
  /// @throws NumericalError  the state is not finite or a covariance not positive: epoch and likely causes
  [[nodiscard]] FilterResult run(const FilterState& start, const FilterOutputs& outputs) const;
  /// The same up to `end`.
  [[nodiscard]] FilterResult run_until(const FilterState& start, geo::GpsTime end, const FilterOutputs& outputs) const;
  /// Continues from a knot (after its updates) to `end`: used repeatedly by an outage study.
  [[nodiscard]] FilterResult resume(const Knot& knot, geo::GpsTime end, const FilterOutputs& outputs) const;

 private:
  Mission mission_;
  FilterOptions options_;
  StateLayout layout_;
  double knot_interval_;
};

/// Increment of sample `index` that begins at `now`: a gap before the sample is bridged with the sample's own mean rate.
/// @param remainder  remaining part of the sample if a knot split it; dt = 0: the sample is unused
[[nodiscard]] ins::RawIncrement increment_from(const record::ImuRecording& imu, std::size_t index,
                                               const ins::RawIncrement& remainder, geo::GpsTime now);

}  // namespace coast::estimate
