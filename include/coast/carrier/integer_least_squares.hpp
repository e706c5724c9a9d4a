#pragma once
// The integers of carrier-phase ambiguities.

#include <Eigen/Core>

namespace coast::carrier {

struct IntegerSolutions {
  Eigen::MatrixXd candidates;     ///< n x m, the best first; fewer columns where the search was given up
  Eigen::VectorXd squared_norms;  ///< (a - z)' Q^-1 (a - z) of each, ascending
  /// Probability that rounding in order of the decorrelated ambiguities gives all integers right, if Q is true: a lower bound
  /// of that of the best candidate (Teunissen 1999).
  double success_rate = 0.0;

  /// Second-best over best: how much the best stands out. Infinite where the best fits exactly, 0 with one candidate.
  [[nodiscard]] double ratio() const;
};

/// The integer vectors nearest to the float ambiguities in the metric of their covariance: decorrelation by integer Gauss
/// transformations and permutations (Teunissen 1995: LAMBDA), depth-first search from the inside out (Chang, Yang & Zhou 2005:
/// MLAMBDA).
/// @param a  float ambiguities, cycles  @param Q  their covariance, cycles^2, symmetric and positive definite
/// @param count  candidates wanted, 2 for the ratio test
/// @throws std::invalid_argument  sizes that do not fit, or no candidate wanted
/// @throws NumericalError  Q is not positive definite
[[nodiscard]] IntegerSolutions integer_least_squares(const Eigen::VectorXd& a, const Eigen::MatrixXd& Q, int count = 2);

}  // namespace coast::carrier
