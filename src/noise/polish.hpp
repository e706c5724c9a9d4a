#pragma once
// The last steps to an optimum of the likelihood. Private to the room.

#include "coast/noise/estimators.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

/// Ranges of the parameters; for fixed ones both ends are the start value.
[[nodiscard]] std::vector<Interval> box_of(const Likelihood& likelihood, const std::vector<double>& start,
                                           const FixedParameters& fixed);

/// Gauss-Newton with Levenberg's damping, within the box, until the predicted gain in log-likelihood is below the
/// tolerance.
/// @param excess  of the curvature over the information, from block means; empty: zero
/// @param fit     start in, optimum out; trace and passes are added to
using SlopeFunction = std::function<LikelihoodSlope(const std::vector<double>&)>;
struct PolishOptions {
  double tolerance = 1e-7;
  int steps = 60;  ///< maximum
  /// The curvature is corrected by what each step shows of it (Broyden, Fletcher, Goldfarb & Shanno): where the information is
  /// an approximation, such as that of the spectrum for a line narrower than its bins.
  bool learns = false;
};
void polish(const SlopeFunction& likelihood, const SumModel& model, const std::vector<Interval>& box,
            const Eigen::MatrixXd& excess, const PolishOptions& options, Fit& fit);

/// Minus the Hessian of the log-likelihood by central differences of its gradient, minus the information.
[[nodiscard]] Eigen::MatrixXd excess_curvature(const SlopeFunction& likelihood, const std::vector<double>& u);

}  // namespace coast::noise
