#pragma once
// The last steps to an optimum of the likelihood. Private to the room.

#include "coast/noise/estimators.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

/// Ranges of the parameters; those that are fixed have theirs at the start.
[[nodiscard]] std::vector<Interval> box_of(const Likelihood& likelihood, const std::vector<double>& start,
                                           const FixedParameters& fixed);

/// Gauss-Newton with Levenberg's damping, within the box, until the quadratic model promises less than the tolerance of
/// log-likelihood.
/// @param excess  of the curvature over the information, known from block means; empty: taken as none
/// @param fit     start in, optimum out; trace and passes are added to
using SlopeFunction = std::function<LikelihoodSlope(const std::vector<double>&)>;
struct PolishOptions {
  double tolerance = 1e-7;
  int steps = 60;  ///< at most
};
void polish(const SlopeFunction& likelihood, const SumModel& model, const std::vector<Interval>& box,
            const Eigen::MatrixXd& excess, const PolishOptions& options, Fit& fit);

/// Minus the Hessian of the log-likelihood by central differences of its gradient, less the information.
[[nodiscard]] Eigen::MatrixXd excess_curvature(const SlopeFunction& likelihood, const std::vector<double>& u);

}  // namespace coast::noise
