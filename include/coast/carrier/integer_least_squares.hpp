#pragma once
// Integer least squares for carrier-phase ambiguities.

#include <Eigen/Core>

namespace coast::carrier {

struct IntegerSolutions {
  Eigen::MatrixXd candidates;     ///< n x m, the best first; fewer columns if the search was stopped
  Eigen::VectorXd squared_norms;  ///< (a - z)' Q^-1 (a - z) of each, ascending
  /// Probability that integer bootstrapping of the decorrelated ambiguities gives all integers right, if Q is correct: a lower
  /// bound of the success rate of the best candidate (Teunissen 1999).
  double success_rate = 0.0;

  /// Second-best over best: the ratio test statistic. Infinite if the best fits exactly, 0 with one candidate.
  [[nodiscard]] double ratio() const;
};

/// The integer vectors nearest to the float ambiguities in the metric of their covariance: decorrelation by integer Gauss
/// transformations and permutations (Teunissen 1995: LAMBDA), depth-first search from the inside out (Chang, Yang & Zhou 2005:
/// MLAMBDA).
/// @param a  float ambiguities, cycles  @param Q  their covariance, cycles^2, symmetric and positive definite
/// @param count  number of candidates, 2 for the ratio test
/// @param least_success  with a smaller success rate there are no candidates: the search would take long and mean nothing
/// @throws std::invalid_argument  sizes that do not fit, or count below 1
/// @throws NumericalError  Q is not positive definite
[[nodiscard]] IntegerSolutions integer_least_squares(const Eigen::VectorXd& a, const Eigen::MatrixXd& Q, int count = 2,
                                                     double least_success = 0.0);

}  // namespace coast::carrier
