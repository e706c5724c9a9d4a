#pragma once
// Batch smoother: the whole mission as one sparse nonlinear least-squares problem.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"
#include "coast/estimate/observability.hpp"
#include "coast/estimate/smoother.hpp"

namespace coast::estimate {

/// Robust loss of a GNSS position or velocity with normalised residual u, u^2 = nu' R^-1 nu / 3.
struct RobustLoss {
  enum class Kind {
    kSquared,       ///< u^2: no down-weighting
    kHuber,         ///< u^2 up to c, 2 c u - c^2 beyond: weight c/u
    kCauchy,        ///< c^2 log(1 + u^2/c^2): weight 1/(1 + u^2/c^2)
    kGemanMcClure,  ///< u^2/(1 + u^2/c^2): weight 1/(1 + u^2/c^2)^2
  } kind = Kind::kSquared;
  double scale = 2.0;  ///< c

  [[nodiscard]] double value(double u2) const;
  /// Weight of the squared innovation in iteratively reweighted least squares: the derivative of the value.
  [[nodiscard]] double weight(double u2) const;
};

struct BatchOptions {
  RobustLoss gnss = {};
  int most_iterations = 30;
  /// Memory limit for normal equations and factor together; if absent, four fifths of the installed memory.
  std::optional<std::int64_t> most_bytes = {};
};

/// A measurement of a forward pass.
struct KnotMeasurement {
  std::size_t knot = 0;
  Measurement what;
  bool used = true;  ///< by the filter
};

/// Convergence of the solution, and its estimates for the whole mission.
struct BatchReport {
  /// Twice the negative logarithm of the posterior density at each linearisation, up to a constant: one per iteration.
  std::vector<double> cost = {};
  bool converged = false;
  double condition = 0.0;                     ///< of the normal equations with scaled unknowns (SparseCholesky::condition)
  std::vector<MissionUnknown> unknowns = {};  ///< all unknowns that are constant over the mission, at the middle knot
  /// Effect of rounding on the solution: of states in sigmas, of sigmas relative. Observed over four decades of the condition
  /// number, within a factor of two (tests/estimate/linear_batch_test.cpp).
  [[nodiscard]] double rounding() const { return 4e-17 * condition; }
};

struct BatchSolution {
  std::vector<SmoothedKnot> smoothed;
  std::vector<double> weights;  ///< of the measurements, in input order: 1, or less by the robust loss; 0: not used
  BatchReport report;
};

/// Gauss-Newton over the states of all knots: prior at the first, transitions between neighbours with the driving noise of the
/// filter, measurements.
///
///     minimise |e_0|^2_P0 + sum |x_k+1 - f(x_k)|^2_Q + sum rho(z - h(x_k))
///
/// f integrates the IMU data again from every knot in every iteration, with the sensor errors estimated there, so the
/// linearisation does not depend on a filter that had drifted. States without driving noise (constants, scale factors, lever
/// arm, time offset) are one unknown each for the whole mission. The normal equations are block tridiagonal with a border,
/// factored by CHOLMOD with a fixed ordering; covariances are elements of the inverse by Takahashi's recursion. They belong to
/// the last linearisation, from which the last step moved the states by less than 1e-3 of their sigmas.
///
/// Normal equations square the condition of the problem, which grows with the inverse of the driving noise: with accelerometers
/// of 2 ug/sqrt(Hz) sigmas have relative errors of 1e-3, those of smooth() 1e-7 (the report's `condition`, and
/// tests/estimate/linear_batch_test.cpp). Memory is 24 bytes for each element of the lower triangle: s (3 s + 1) / 2 + s b per
/// knot, with s unknowns at every knot and b of the mission.
///
/// With the squared loss, the measurements are those that the filter used; with another loss all GNSS measurements enter, with
/// weights.
/// @param start         start state of the filter: its state and covariance are the prior
/// @param knots         of a forward pass from `start`; its states are the first linearisation point
/// @param states        knots for which x and sd are stored
/// @throws NumericalError         no driving noise on some axis, states that are not finite, or more memory needed than allowed
/// @throws std::invalid_argument  a mission with carrier-phase observations: only the filter supports them
[[nodiscard]] BatchSolution smooth_batch(const Mission& mission, const StateLayout& layout, const FilterOptions& options,
                                         const FilterState& start, const KnotStore& knots,
                                         const std::vector<KnotMeasurement>& measurements, const BatchOptions& batch,
                                         const std::function<void(double)>& progress = {},
                                         const KnotSampling& states = KnotSampling{});

}  // namespace coast::estimate
