#include <cmath>

#include "coast/noise/estimators.hpp"
#include "coast/record/error.hpp"

namespace coast::noise {

Fit fit_em(const Likelihood& likelihood, const std::vector<double>& start, const EmOptions& options) {
  const SumModel& model = likelihood.model();
  const std::vector<Interval> ranges = model.ranges(likelihood.scale());
  Fit fit;
  fit.u = start;
  std::vector<double> memory;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    if (options.progress) options.progress(static_cast<double>(iteration) / options.iterations);
    const Likelihood::Expectation at = likelihood.expectation(fit.u, memory);
    ++fit.passes;
    if (!std::isfinite(at.log_likelihood)) {
      if (iteration == 0) throw NumericalError("the log-likelihood is not finite at the start of EM", "", "other start values");
      break;
    }
    fit.converged = !fit.trace.empty() && at.log_likelihood - fit.trace.back() < options.tolerance;
    fit.trace.push_back(at.log_likelihood);
    fit.log_likelihood = at.log_likelihood;
    if (fit.converged || iteration + 1 == options.iterations) break;
    for (std::size_t i = 0; i < model.terms().size(); ++i) {
      const SumModel::Term& term = model.terms()[i];
      std::vector<bool> fixed(term.parameters, false);
      for (std::size_t k = 0; k < term.parameters && !options.fixed.empty(); ++k) fixed[k] = options.fixed[term.parameter + k];
      term.process->maximise(at.moments[i], likelihood.interval(), fixed,
                             std::span(fit.u).subspan(term.parameter, term.parameters));
    }
    for (std::size_t i = 0; i < fit.u.size(); ++i) fit.u[i] = std::clamp(fit.u[i], ranges[i].lower, ranges[i].upper);
  }
  return fit;
}

}  // namespace coast::noise
