#pragma once
// Values with known sigmas and an unknown scatter between missions, by restricted likelihood.

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace coast::fleet {

/// What missions of one unit scatter by, beyond their stated sigmas.
struct Scatter {
  double tau = 0.0;   ///< independent from mission to mission, [value]
  double walk = 0.0;  ///< random walk, [value]/sqrt(year)
};

/// Values of one unit, and a design with one column per unknown.
struct Observations {
  Eigen::VectorXd y;
  Eigen::VectorXd sigma;  ///< > 0
  Eigen::VectorXd t;      ///< years, ascending; used by the walk alone
  Eigen::MatrixXd X;      ///< full column rank
};

/// y = X beta + b + e,  e ~ N(0, sigma_i^2),  b ~ N(0, tau^2) independent, and a random walk from the first mission on:
///
///     V = diag(sigma_i^2 + tau^2) + walk^2 min(t_i - t_1, t_j - t_1)
///
/// @return  lower Cholesky factor of V
[[nodiscard]] Eigen::MatrixXd scatter_factor(const Eigen::VectorXd& sigma, const Eigen::VectorXd& t, const Scatter& scatter);

/// Weighted least squares at a known scatter.
struct LeastSquares {
  Eigen::VectorXd beta;
  Eigen::MatrixXd covariance;  ///< (X'V^-1 X)^-1
  double log_det = 0.0;        ///< log|V| + log|X'V^-1 X|
  double chi_square = 0.0;     ///< r'V^-1 r
};
[[nodiscard]] LeastSquares least_squares(const Observations& observations, const Scatter& scatter);

/// Restricted log-likelihood without its constant: -(log|V| + log|X'V^-1 X| + r'V^-1 r)/2.
/// @see   Harville (1977), eq. (4.3) up to the constant; docs/decisions/0008-restricted-likelihood.md
[[nodiscard]] double restricted_log_likelihood(const Observations& observations, const Scatter& scatter);

struct RandomEffects {
  Eigen::VectorXd beta;
  Eigen::MatrixXd covariance;  ///< (X'V^-1 X)^-1, times Hartung and Knapp's factor
  int dof = 0;                 ///< n - columns
  Scatter scatter;
  std::pair<double, double> tau_95;  ///< profile of the restricted likelihood: 2 (max - l(tau)) <= 3.841

  /// 95 % interval of an unknown: Student's t with n - columns degrees of freedom. @see Hartung and Knapp (2001)
  [[nodiscard]] std::pair<double, double> interval_95(Eigen::Index unknown) const;
  [[nodiscard]] double sd(Eigen::Index unknown) const;
};

/// Fits one unit (or the values of all units, for the scatter between them); tau by restricted likelihood, no walk.
///
/// With as many values as unknowns there is no scatter to be seen: tau is 0 and the covariance is that of the stated sigmas
/// (dof 0).
/// @throws std::invalid_argument  fewer values than unknowns
[[nodiscard]] RandomEffects random_effects(const Observations& observations);

/// tau and, where it is asked for, walk of a whole panel: the same for all units.
[[nodiscard]] Scatter panel_scatter(const std::vector<Observations>& units, bool with_walk);

}  // namespace coast::fleet
