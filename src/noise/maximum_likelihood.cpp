#include "bounded_search.hpp"
#include "coast/noise/estimators.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

/// Variances that start at nothing are lifted to where the likelihood's slope in their logarithm can be told from zero: at
/// nothing every start is a stationary point.
void lift_from_zero(const Likelihood& likelihood, const std::vector<Interval>& box, std::vector<double>& u) {
  constexpr double kNothing = 15.0;  // the range spans 42
  constexpr double kSmall = 15.0;    // below the upper end: 3e-4 of the signal
  for (std::size_t i = 0; i < u.size(); ++i)
    if (likelihood.model().parameter(i).kind == ParameterInfo::Kind::kVariance && u[i] < box[i].lower + kNothing)
      u[i] = std::clamp(box[i].upper - kSmall, box[i].lower, box[i].upper);
}

/// A likelihood may have a second top where a process is not there. Where the sum without it is nearly as likely, its top is
/// looked for too.
void try_without(const Likelihood& likelihood, const std::vector<Interval>& box, const Eigen::MatrixXd& excess,
                 double tolerance, Fit& fit) {
  constexpr double kNear = 3.0;  // of log-likelihood, before the others have moved
  for (std::size_t i = 0; i < box.size(); ++i) {
    if (likelihood.model().parameter(i).kind != ParameterInfo::Kind::kVariance || fit.u[i] <= box[i].lower) continue;
    Fit other;
    other.u = fit.u;
    other.u[i] = box[i].lower;
    ++fit.passes;
    if (likelihood.value(other.u).log_likelihood < fit.log_likelihood - kNear) continue;
    polish([&](const std::vector<double>& u) { return likelihood.slope(u); }, likelihood.model(), box, excess,
           {.tolerance = tolerance}, other);
    fit.passes += other.passes;
    if (!(other.log_likelihood > fit.log_likelihood)) continue;
    fit.u = other.u;
    fit.log_likelihood = other.log_likelihood;
    fit.converged = other.converged;
    fit.trace.push_back(other.log_likelihood);
  }
}

}  // namespace

Fit fit_maximum_likelihood(const Likelihood& likelihood, const std::vector<double>& start,
                           const MaximumLikelihoodOptions& options) {
  constexpr int kIterations = 30;
  constexpr int kShortSteps = 12;
  constexpr double kGradient = 1e-3;
  constexpr double kShortTolerance = 1e-5;
  const std::vector<Interval> box = box_of(likelihood, start, options.fixed);
  Fit fit;
  fit.u = start;
  for (std::size_t i = 0; i < box.size(); ++i) fit.u[i] = std::clamp(fit.u[i], box[i].lower, box[i].upper);
  lift_from_zero(likelihood, box, fit.u);
  const auto search = [&](const auto& of) {
    return search_within(fit.u, box, kGradient, kIterations, [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
      const LikelihoodSlope at = of.slope(u);
      gradient = -at.gradient;
      return -at.log_likelihood;
    });
  };
  Eigen::MatrixXd excess;
  const ShortLikelihood shortened(likelihood);
  if (options.pyramid && !shortened.is_whole()) {
    fit.u = search(shortened).u;
    polish([&](const std::vector<double>& u) { return shortened.slope(u); }, likelihood.model(), box, {},
           {.tolerance = kShortTolerance, .steps = kShortSteps}, fit);
    fit.trace.clear();
    fit.passes = 0;
    excess = excess_curvature([&](const std::vector<double>& u) { return shortened.slope(u); }, fit.u);
  } else {
    const SearchResult found = search(likelihood);
    fit.u = found.u;
    fit.passes += found.evaluations;
    for (const double value : found.trace) fit.trace.push_back(-value);
  }
  if (options.polished) {
    polish([&](const std::vector<double>& u) { return likelihood.slope(u); }, likelihood.model(), box, excess,
           {.tolerance = options.tolerance}, fit);
    try_without(likelihood, box, excess, options.tolerance, fit);
  } else {
    fit.log_likelihood = shortened.value(fit.u);
  }
  return fit;
}

}  // namespace coast::noise
