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
  }
  polish(likelihood, box, excess, options.tolerance, fit);
  return fit;
}

}  // namespace coast::noise
