#pragma once
// The closed-loop error-state filter: strapdown from knot to knot, covariance with composed transitions, updates at knots.

#include <functional>
#include <optional>
#include <vector>

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

/// GNSS that the filter does not see. A tightly coupled one sees the highest satellites if some are left.
struct Withheld {
  geo::GpsTime from;
  geo::GpsTime to;
  int satellites_left = 0;
  [[nodiscard]] bool contains(geo::GpsTime t) const { return from <= t && t < to; }
};

/// What is known of the motion behind a long gap of the IMU without what was before it: by then the heading may be any, and a
/// linear filter does not find it back.
struct Restart {
  record::NavState nav;  ///< takes the place of the filter's attitude at nav.t; of position and velocity where those are lost
  Eigen::Vector3d sd_position_n;
  Eigen::Vector3d sd_velocity_n;
  std::optional<Eigen::Vector3d> sd_attitude_n;  ///< rotations about N, E, D; absent: the attitude stays the filter's
};

/// What is filtered. The recordings must outlive the filter.
struct Mission {
  const record::ImuRecording& imu;  ///< body axes
  const record::GnssRecording& gnss;
  ins::IncrementKind increments = ins::IncrementKind::kRaw;
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();  ///< the error model lives in sensor axes
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;             ///< a fix tagged t is valid at t - offset
  std::vector<TimeSpan> standstill = {};  ///< in order; zero-velocity updates where asked for
  double earth_rate = geo::kEarthRate;    ///< negative for a recording run backwards
  /// Where known drifts are zero; where absent, the beginning of the recording.
  std::optional<geo::GpsTime> first_epoch = {};
  /// Tight coupling: these are used in place of the fixes. Must outlive the filter.
  const CarrierObservations* carrier = nullptr;
  std::vector<Restart> restarts = {};  ///< ascending; each becomes a knot
};

/// Factors on the stated GNSS standard deviations.
struct GnssScale {
  double horizontal = 1.0;
  double vertical = 1.0;
  double velocity = 1.0;
};

/// What is known of a vehicle's motion.
struct VehicleConstraints {
  std::optional<NonHolonomic> non_holonomic;
  std::optional<double> zero_velocity_sd_mps;
  double interval_s = 0.5;     ///< at most one of each per interval: slips last, they are not new every sample
  double min_speed_mps = 0.2;  ///< below it only standstill says something
};

struct FilterOptions {
  AuxiliaryStates auxiliary;
  GnssScale gnss_scale;
  bool use_gnss_velocity = true;
  double gate_probability = 1e-6;  ///< share of good fixes that the gate may refuse; 0: no gate
  double gate_patience_s = 3.0;    ///< fixes refused for longer are taken: it is the filter that is wrong
  double knot_interval_s = 0.5;    ///< longest interval between knots
  /// Further instants that become knots, ascending.
  std::vector<geo::GpsTime> knots_at = {};
  VehicleConstraints vehicle;
  std::vector<Withheld> withheld;
};

/// One innovation, resolved for people: GNSS in N, E, D; non-holonomic as lateral, vertical in the first two; of carrier phases
/// what they move the antenna by; of a member's difference its axes.
struct InnovationRecord {
  geo::GpsTime t;
  UpdateKind kind = UpdateKind::kGnssPosition;
  bool used = true;
  int dof = 3;
  Eigen::Vector3d nu = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();  ///< square roots of the diagonal of S
  double nis = 0.0;
  double largest_sd = 0.0;  ///< square root of the largest eigenvalue of S: what the gate can see
  record::FixQuality quality = record::FixQuality::kUnknown;
};

/// Which measurement of a mission: what is needed to linearise it again.
struct Measurement {
  UpdateKind kind = UpdateKind::kGnssPosition;
  std::size_t index = 0;                        ///< of the fix, or of the members' block
  noise::Sensor sensor = noise::Sensor::kGyro;  ///< of a member's difference
  std::size_t member = 0;                       ///< likewise
  std::vector<std::size_t> left_out = {};       ///< likewise: members refused in this block
};

/// Positions that differ from one instant on and were refused, until they were followed.
struct GnssJump {
  geo::GpsTime t;
  Eigen::Vector3d by_n;  ///< fixes less filter where they were followed, north east down, m
};

struct FilterResult {
  FilterState last;
  std::vector<InnovationRecord> innovations;
  double log_likelihood = 0.0;  ///< of the used updates' innovations
  std::vector<GnssJump> jumps;
  record::Events events;  ///< `gnss_jump` of each, among others
};

/// Where a pass delivers; every member may be empty.
struct FilterOutputs {
  KnotStore* knots = nullptr;
  /// What `knots` keeps, one at a time, with the white noise of its interval; called at the knot that ends it.
  std::function<void(const Knot&, const WhiteNoise&)> closed_knots = {};
  record::EpochSink epochs;                          ///< filtered state at IMU epochs
  std::function<void(const FilterState&)> at_knots;  ///< before the knot's updates
  /// Every measurement, and whether it was used, at the knot that comes next. Not of carrier phases.
  std::function<void(const Measurement&, bool)> measurements;
  std::function<void(double)> progress;  ///< fraction done
};

class ForwardFilter {
 public:
  /// @throws std::invalid_argument  an option is out of its range
  /// @throws InputError  members that are not those of the error model, or without white noise in it
  ForwardFilter(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options);

  [[nodiscard]] const StateLayout& layout() const { return layout_; }
  /// Covariance of a start: navigation standard deviations in N, E, D, the rest from the error model. Sensor states have
  /// the means that the model knows beforehand, as they are at nav.t.
  [[nodiscard]] FilterState initial_state(const record::NavState& nav, const Eigen::Vector3d& sd_position_n,
                                          const Eigen::Vector3d& sd_velocity_n, const Eigen::Vector3d& sd_attitude_n) const;

  /// Filters from the start state to the end of the recording.
  /// @throws NumericalError  the state is not finite or a covariance not positive: epoch and likely causes
  [[nodiscard]] FilterResult run(const FilterState& start, const FilterOutputs& outputs) const;
  /// The same up to `end`.
  [[nodiscard]] FilterResult run_until(const FilterState& start, geo::GpsTime end, const FilterOutputs& outputs) const;
  /// Filters on from a knot (its updates are done) to `end`: what an outage study repeats.
  [[nodiscard]] FilterResult resume(const Knot& knot, geo::GpsTime end, const FilterOutputs& outputs) const;

 private:
  Mission mission_;
  FilterOptions options_;
  StateLayout layout_;
  double knot_interval_;
};

/// Increment of sample `index` that begins at `now`: a gap before the sample is bridged with the sample's own mean rate.
/// @param remainder  what is left of the sample where a knot split it; dt = 0: nothing was used
[[nodiscard]] ins::RawIncrement increment_from(const record::ImuRecording& imu, std::size_t index,
                                               const ins::RawIncrement& remainder, geo::GpsTime now);

}  // namespace coast::estimate
