#pragma once
// The whole mission as one sparse nonlinear least-squares problem.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"
#include "coast/estimate/observability.hpp"
#include "coast/estimate/smoother.hpp"

namespace coast::estimate {

/// How much a GNSS position or velocity counts that lies u standard deviations off, u^2 = nu' R^-1 nu / 3.
struct RobustLoss {
  enum class Kind {
    kSquared,       ///< u^2: none is doubted
    kHuber,         ///< u^2 up to c, 2 c u - c^2 beyond: weight c/u
    kCauchy,        ///< c^2 log(1 + u^2/c^2): weight 1/(1 + u^2/c^2)
    kGemanMcClure,  ///< u^2/(1 + u^2/c^2): weight 1/(1 + u^2/c^2)^2
  } kind = Kind::kSquared;
  double scale = 2.0;  ///< c

  [[nodiscard]] double value(double u2) const;
  /// Of the squared innovation in iteratively reweighted least squares: the derivative of the value.
  [[nodiscard]] double weight(double u2) const;
};

struct BatchOptions {
  RobustLoss gnss = {};
  int most_iterations = 30;
  /// Of normal equations and factor together; where absent, four fifths of the memory that is installed.
  std::optional<std::int64_t> most_bytes = {};
};

/// A measurement that a forward pass met.
struct KnotMeasurement {
  std::size_t knot = 0;
  Measurement what;
  bool used = true;  ///< by the filter
};

/// How the solution came about, and what it says of the mission as a whole.
struct BatchReport {
  /// Twice the negative logarithm of the posterior density at each linearisation, to a constant: one per iteration.
  std::vector<double> cost = {};
  bool converged = false;
  double condition = 0.0;                     ///< of the normal equations, their unknowns scaled (SparseCholesky::condition)
  std::vector<MissionUnknown> unknowns = {};  ///< all that are one for the mission, at the knot in the middle
  /// What rounding takes from the solution: of states in sigmas, of sigmas relative. Seen over four decades of the condition
  /// number, to a factor of two (tests/estimate/linear_batch_test.cpp).
  [[nodiscard]] double rounding() const { return 4e-17 * condition; }
};

struct BatchSolution {
  std::vector<SmoothedKnot> smoothed;
  std::vector<double> weights;  ///< of the measurements in the order given: 1, or less by the robust loss; 0: left out
  BatchReport report;
};

/// Gauss-Newton over the states of all knots: prior at the first, transitions between neighbours with the driving noise of the
/// filter, measurements.
///
///     minimise |e_0|^2_P0 + sum |x_k+1 - f(x_k)|^2_Q + sum rho(z - h(x_k))
///
/// f integrates the IMU again from every knot in every iteration, with the sensor errors estimated there: nothing is linearised
/// about a filter that had drifted. States without driving noise (constants, scale factors, lever arm, time offset) are one
/// unknown each for the whole mission. The normal equations are a chain with a border, factored by CHOLMOD in an order that is
/// kept; covariances are elements of the inverse by Takahashi's recursion. They are those of the last linearisation, from which
/// the last step took the states by less than 1e-3 of their sigmas.
///
/// Normal equations square the condition of the problem, which grows with the inverse of the driving noise: with accelerometers
/// of 2 ug/sqrt(Hz) sigmas are off by 1e-3 of themselves where those of smooth() are right to 1e-7 (the report's `condition`,
/// and tests/estimate/linear_batch_test.cpp). Memory is 24 bytes for each element of the lower triangle: of s unknowns at every
/// knot and b of the mission s (3 s + 1) / 2 + s b a knot.
///
/// With a squared loss the measurements are those that the filter used; with another all GNSS are in, and weighed.
/// @param start         of the filter: its state and covariance are the prior
/// @param knots         of a forward pass from there, its states the first linearisation
/// @param states        knots that keep x and sd
/// @throws NumericalError         no driving noise on some axis, states that are not finite, or more memory needed than allowed
/// @throws std::invalid_argument  a mission with carrier-phase observations: they are filtered
[[nodiscard]] BatchSolution smooth_batch(const Mission& mission, const StateLayout& layout, const FilterOptions& options,
                                         const FilterState& start, const KnotStore& knots,
                                         const std::vector<KnotMeasurement>& measurements, const BatchOptions& batch,
                                         const std::function<void(double)>& progress = {},
                                         const KnotSampling& states = KnotSampling{});

}  // namespace coast::estimate
