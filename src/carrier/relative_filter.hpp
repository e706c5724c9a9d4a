#pragma once
// The float solution: an extended Kalman filter over a baseline's double differences. Private to the room.

#include <Eigen/Cholesky>

#include "coast/carrier/ppk.hpp"
#include "double_differences.hpp"

namespace coast::carrier {

/// State after an epoch, and what was found on the way.
struct FloatEpoch {
  bool updated = false;  ///< double differences have been used
  DoubleDifferences dd;  ///< as used, linearised at the predicted position
  Eigen::VectorXd step;  ///< of the state, by the update
  std::vector<SignalResidual> left_out;
  Shortfall shortfall = Shortfall::kNone;
};

/// Whitened double differences with their predicted covariance.
struct Innovation {
  Eigen::MatrixXd H;
  Eigen::VectorXd v;
  Eigen::MatrixXd PHt;
  Eigen::LLT<Eigen::MatrixXd> S;
};

class RelativeFilter {
 public:
  /// Options with `air` and `noise` settled.
  RelativeFilter(const PpkOptions& options, double interval);

  /// Epochs in order of time, or all of them against it.
  FloatEpoch step(const DifferenceEpoch& epoch);
  [[nodiscard]] const RelativeState& state() const { return state_; }

 private:
  bool predict_position(const DifferenceEpoch& epoch, double dt);
  void forget_unseen(const DifferenceEpoch& epoch);
  void predict_ambiguities(const DifferenceEpoch& epoch, double dt);
  void predict_zenith_delay(const Eigen::Vector3d& baseline_e, const Eigen::Vector3d& up_e, double dt);
  void predict_ionosphere(const DifferenceEpoch& epoch, double baseline, double dt);
  void start_anew(const SatelliteDifference& satellite, const BandDifference& band);
  /// Finds what contradicts the rest, leaves codes out, forgets ambiguities of phases; then updates.
  void update(const DifferenceEpoch& epoch, FloatEpoch& result);
  void apply(const Innovation& in, const DifferenceEpoch& epoch, FloatEpoch& result);

  const PpkOptions& options_;
  Weighting weighting_;
  double interval_;
  RelativeState state_;
  bool started_ = false;
  geo::GpsTime last_;
  std::map<Unknown, double> ionosphere_;  ///< stationary variance, m^2
  std::map<Unknown, geo::GpsTime> seen_;  ///< last, of ambiguities and ionospheric delays
};

}  // namespace coast::carrier
