#include "block_rule.hpp"
#include "bounded_search.hpp"
#include "coast/noise/estimators.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

/// Blocks for the search: as long as the processes allow, but enough of them.
std::size_t search_block(const Likelihood& likelihood, const std::vector<double>& u) {
  constexpr double kFewestBlocks = 4000.0;
  const auto enough = static_cast<std::size_t>(std::max(1.0, likelihood.samples() / kFewestBlocks));
  return std::min(enough, slow_block(likelihood.model(), u, likelihood.interval()));
}

/// Variances that start at nothing are lifted to where the likelihood's slope in their logarithm can be told from zero: at
/// nothing every start is a stationary point.
void lift_from_zero(const Likelihood& likelihood, const std::vector<Interval>& box, std::vector<double>& u) {
  constexpr double kNothing = 15.0;  // the range spans 42
  constexpr double kSmall = 15.0;    // below the upper end: 3e-4 of the signal
  for (std::size_t i = 0; i < u.size(); ++i)
    if (likelihood.model().parameter(i).kind == ParameterInfo::Kind::kVariance && u[i] < box[i].lower + kNothing)
      u[i] = std::clamp(box[i].upper - kSmall, box[i].lower, box[i].upper);
}

SearchResult search(const Likelihood& likelihood, const std::vector<double>& start, const std::vector<Interval>& box) {
  constexpr int kIterations = 200;
  const double gradient_tolerance = 1e-3;
  return search_within(start, box, gradient_tolerance, kIterations,
                       [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
                         const LikelihoodSlope at = likelihood.slope(u);
                         gradient = -at.gradient;
                         return -at.log_likelihood;
                       });
}

}  // namespace

Fit fit_maximum_likelihood(const Likelihood& likelihood, const std::vector<double>& start,
                           const MaximumLikelihoodOptions& options) {
  const std::vector<Interval> box = box_of(likelihood, start, options.fixed);
  Fit fit;
  fit.u = start;
  for (std::size_t i = 0; i < box.size(); ++i) fit.u[i] = std::clamp(fit.u[i], box[i].lower, box[i].upper);
  lift_from_zero(likelihood, box, fit.u);
  const std::size_t block = options.pyramid ? search_block(likelihood, fit.u) : 1;
  Eigen::MatrixXd excess;
  if (block > 1) {
    std::vector<StaticSignal> means;
    for (const Detrended& record : likelihood.records()) means.push_back(block_means(record.signal, block));
    const Likelihood coarse(means, likelihood.model());
    fit.u = search(coarse, fit.u, box).u;
    excess = excess_curvature(coarse, fit.u);
  } else {
    const SearchResult found = search(likelihood, fit.u, box);
    fit.u = found.u;
    fit.passes += found.evaluations;
    for (const double value : found.trace) fit.trace.push_back(-value);
  }
  polish(likelihood, box, excess, options.tolerance, fit);
  return fit;
}

}  // namespace coast::noise
