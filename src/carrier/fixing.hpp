#pragma once
// From float ambiguities to integers. Private to the room.

#include "relative_filter.hpp"

namespace coast::carrier {

/// An ambiguity less that of its reference is this integer.
struct FixedPair {
  Unknown ambiguity, reference;
  double integer = 0.0;
};

struct FixedSolution {
  bool fixed = false;
  Eigen::VectorXd x;  ///< the state with the integers
  Eigen::Matrix3d position_covariance_e = Eigen::Matrix3d::Zero();
  std::vector<record::Satellite> satellites;  ///< with integers
  std::vector<FixedPair> pairs;
  int ambiguities = 0;
  double ratio = 0.0;
  double success_rate = 0.0;
  Shortfall shortfall = Shortfall::kNone;
};

/// Integers of all ambiguities of an epoch, or, where these do not stand out, of those of most satellites (partial fixing).
class AmbiguityFixing {
 public:
  explicit AmbiguityFixing(const FixingOptions& options) : options_(options) {}

  FixedSolution fix(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state);

 private:
  const FixingOptions& options_;
  std::vector<record::Satellite> without_;  ///< satellites that had to be left float last time
};

/// Fix and hold: which integers have come out often enough to be kept as measurements.
class IntegerHold {
 public:
  /// To be told of every fixed epoch. @return the pairs that have been the same for some epochs in a row
  std::vector<FixedPair> agreed(const FixedSolution& fixed);

 private:
  struct Candidate {
    double value = 0.0;  ///< cycles, against whatever the group was referred to
    int epochs = 0;      ///< in a row
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
