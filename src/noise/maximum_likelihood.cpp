#include "bounded_search.hpp"
#include "coast/noise/estimators.hpp"
#include "polish.hpp"

namespace coast::noise {

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
    polish([&](const std::vector<double>& u) { return shortened.slope(u); }, box, {},
           {.tolerance = kShortTolerance, .steps = kShortSteps}, fit);
    fit.trace.clear();
    fit.passes = 0;
    excess = excess_curvature(shortened, fit.u);
  } else {
    const SearchResult found = search(likelihood);
    fit.u = found.u;
    fit.passes += found.evaluations;
  }
  if (options.polished) {
    polish([&](const std::vector<double>& u) { return likelihood.slope(u); }, box, excess, {.tolerance = options.tolerance},
           fit);
  } else {
    fit.log_likelihood = shortened.value(fit.u);
  }
  return fit;
}

}  // namespace coast::noise
