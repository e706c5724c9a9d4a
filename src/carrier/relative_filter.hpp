#pragma once
// The float solution: an extended Kalman filter over a baseline's double differences. Private to the room.

#include <Eigen/Cholesky>

#include "coast/carrier/ppk.hpp"
#include "double_differences.hpp"
#include "known_integers.hpp"

namespace coast::carrier {

/// State after an epoch, and what was found on the way.
struct FloatEpoch {
  bool updated = false;  ///< double differences have been used
  DoubleDifferences dd;  ///< as used, linearised at the predicted position
  Eigen::MatrixXd H;     ///< of the differences, whitened
  Eigen::VectorXd nu;    ///< their innovations
  double nis = 0.0;      ///< normalised innovations squared
  Eigen::VectorXd step;  ///< of the state, by the update
  std::vector<SignalResidual> left_out;
  std::vector<Unknown> restarted;  ///< ambiguities that the phases contradict
  Shortfall shortfall = Shortfall::kNone;
};

/// Measurements of unit variance with their predicted covariance.
struct Innovation {
  Eigen::MatrixXd H;
  Eigen::VectorXd v;
  Eigen::MatrixXd PHt;
  Eigen::LLT<Eigen::MatrixXd> S;
};

/// How long an unknown of a satellite is kept after its last observation, s.
double longest_unseen(const Unknown& unknown, double interval);

class RelativeFilter {
 public:
  /// Options with `air` and `noise` set.
  RelativeFilter(const PpkOptions& options, double interval);
  /// For a filter with an external prior position: two satellites already give information.
  static RelativeFilter coupled(const PpkOptions& options, double interval);

  /// Epochs in time order, or all in reverse time order.
  /// @param known  integers of phases of this epoch
  FloatEpoch step(const DifferenceEpoch& epoch, const std::vector<FixedPair>& known = {});
  /// The same with an external prior of the rover: `prior` replaces this filter's own state.
  FloatEpoch step_from(RelativeState prior, const DifferenceEpoch& epoch);
  /// Applies further measurements of unit variance: v = H (truth - state) + noise.
  void absorb(const Eigen::MatrixXd& H, const Eigen::VectorXd& v);
  [[nodiscard]] const RelativeState& state() const { return state_; }
  [[nodiscard]] std::vector<StateChange> take_changes() { return state_.take_changes(); }

 private:
  FloatEpoch step_with_position(const DifferenceEpoch& epoch, double dt, const std::vector<FixedPair>& known);
  void absorb_new(std::vector<FixedPair> known);
  bool predict_position(const DifferenceEpoch& epoch, double dt);
  bool move_by_doppler(const DifferenceEpoch& epoch);
  void forget_unseen(const DifferenceEpoch& epoch);
  void predict_ambiguities(const DifferenceEpoch& epoch, double dt);
  void add_inter_frequency_bias(const BandDifference& band);
  void predict_zenith_delay(const Eigen::Vector3d& baseline_e, const Eigen::Vector3d& up_e, double dt);
  void predict_ionosphere(const DifferenceEpoch& epoch, double baseline, double dt);
  void start_anew(const SatelliteDifference& satellite, const BandDifference& band);
  /// Detects outliers, leaves codes out, resets ambiguities of phases; then updates.
  void update(const DifferenceEpoch& epoch, FloatEpoch& result);
  void leave_out(std::size_t row, const DifferenceEpoch& epoch, LeftOut& out, FloatEpoch& result);
  void apply(const Innovation& in, const DifferenceEpoch& epoch, FloatEpoch& result);
  /// @return the step of the state
  Eigen::VectorXd absorb(const Innovation& in);

  const PpkOptions& options_;
  Weighting weighting_;
  double interval_;
  std::size_t fewest_ = 4;  ///< satellites with which an epoch is used
  RelativeState state_;
  bool started_ = false;
  geo::GpsTime last_;
  std::optional<SinglePoint::Velocity> last_velocity_;
  std::map<Unknown, double> ionosphere_;  ///< stationary variance, m^2
  std::map<Unknown, geo::GpsTime> seen_;  ///< last, of ambiguities and ionospheric delays
};

}  // namespace coast::carrier
