#pragma once
// From float ambiguities to integers. Private to the room.

#include "relative_filter.hpp"

namespace coast::carrier {

struct FixedSolution {
  bool fixed = false;
  Eigen::VectorXd x;                          ///< the state with the integers
  Eigen::MatrixXd P;                          ///< its covariance
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

  /// @param known  integers that the state contains already: if with all ambiguities they are not significant, these are enough
  FixedSolution fix(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state,
                    const std::vector<FixedPair>& known = {});

 private:
  const FixingOptions& options_;
  std::vector<record::Satellite> without_;  ///< satellites left float in the previous epoch
};

}  // namespace coast::carrier
