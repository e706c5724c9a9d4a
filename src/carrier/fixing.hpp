#pragma once
// From float ambiguities to integers. Private to the room.

#include "relative_filter.hpp"

namespace coast::carrier {

struct FixedSolution {
  bool fixed = false;
  Eigen::VectorXd x;  ///< the state with the integers
  Eigen::Matrix3d position_covariance_e = Eigen::Matrix3d::Zero();
  std::vector<record::Satellite> satellites;  ///< with integers
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

}  // namespace coast::carrier
