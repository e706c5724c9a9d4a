#pragma once
// From float ambiguities to integers. Private to the room.

#include "relative_filter.hpp"

namespace coast::carrier {

/// An ambiguity minus that of its reference equals this integer.
struct FixedPair {
  Unknown ambiguity, reference;
  double integer = 0.0;
};

struct FixedSolution {
  bool fixed = false;
  Eigen::VectorXd x;  ///< the state with the integers
  Eigen::Matrix3d position_covariance_e = Eigen::Matrix3d::Zero();
  std::vector<record::Satellite> satellites;  ///< those with integers
  std::vector<FixedPair> pairs;
  int ambiguities = 0;
  double ratio = 0.0;
  double success_rate = 0.0;
  Shortfall shortfall = Shortfall::kNone;
};

/// Integers of all ambiguities of an epoch, or, if these are not significant, of those of most satellites (partial fixing).
class AmbiguityFixing {
 public:
  explicit AmbiguityFixing(const FixingOptions& options) : options_(options) {}

  FixedSolution fix(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state);

 private:
  const FixingOptions& options_;
  std::vector<record::Satellite> without_;  ///< satellites left float in the previous epoch
};

/// Fix and hold: integers fixed often enough to be used as measurements.
class IntegerHold {
 public:
  /// To be called for every fixed epoch. @return the pairs that were the same for some consecutive epochs
  std::vector<FixedPair> agreed(const FixedSolution& fixed);

 private:
  struct Candidate {
    double value = 0.0;  ///< cycles, relative to the reference of its group
    int epochs = 0;      ///< consecutive
  };
  std::map<Unknown, Candidate> candidates_;
};

/// The pairs as measurements of unit variance, for RelativeFilter::absorb.
struct HeldIntegers {
  Eigen::MatrixXd H;
  Eigen::VectorXd nu;
};
HeldIntegers held(const std::vector<FixedPair>& pairs, const RelativeState& state);

}  // namespace coast::carrier
