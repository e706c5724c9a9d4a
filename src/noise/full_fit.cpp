#include "full_fit.hpp"

#include <algorithm>
#include <limits>

#include "polish.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

std::vector<double> shared_start(const SumModel& from, const std::vector<double>& fitted, const SumModel& model,
                                 const std::vector<Interval>& ranges, double below) {
  std::vector<double> u(model.parameters());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const bool variance = model.parameter(i).kind == ParameterInfo::Kind::kVariance;
    u[i] = variance ? ranges[i].upper - below : 0.5 * (ranges[i].lower + ranges[i].upper);
  }
  std::vector<bool> taken(model.terms().size(), false);
  for (const SumModel::Term& own : from.terms())
    for (std::size_t t = 0; t < model.terms().size(); ++t) {
      const SumModel::Term& to = model.terms()[t];
      if (taken[t] || to.process != own.process) continue;
      std::copy_n(fitted.begin() + static_cast<std::ptrdiff_t>(own.parameter), own.parameters,
                  u.begin() + static_cast<std::ptrdiff_t>(to.parameter));
      taken[t] = true;
      break;
    }
  return u;
}

Candidate fit_on_extracts(const std::vector<StaticSignal>& records, const Spectrum& spectrum, const SumModel& model,
                          const std::vector<std::vector<double>>& starts) {
  constexpr double kTolerance = 1e-4;  // of log-likelihood
  constexpr int kSteps = 25;
  const Likelihood likelihood(records, model);
  const ShortLikelihood shortened(likelihood);
  Candidate candidate;
  candidate.model = model;
  double value = -std::numeric_limits<double>::infinity();
  for (const std::vector<double>& start : starts) {
    const double there = shortened.value(start);
    if (!(there > value) && !candidate.fit.u.empty()) continue;
    value = there;
    candidate.fit.u = start;
  }
  const auto by_spectrum = [&](const std::vector<double>& u) { return spectral_slope(spectrum, model, u); };
  polish([&](const std::vector<double>& u) { return shortened.slope(u); }, model, model.ranges(likelihood.scale()),
         excess_curvature(by_spectrum, candidate.fit.u), {.tolerance = kTolerance, .steps = kSteps}, candidate.fit);
  complete(likelihood, shortened, candidate);
  return candidate;
}

Candidate fit_on_all_samples(const std::vector<StaticSignal>& records, const Spectrum& spectrum, const SumModel& model,
                             const std::vector<double>& start, const CalibrationOptions& options) {
  constexpr double kTolerance = 1e-5;  // of log-likelihood
  constexpr int kSteps = 30;
  const Likelihood likelihood(records, model);
  const auto by_spectrum = [&](const std::vector<double>& u) { return spectral_slope(spectrum, model, u); };
  Candidate candidate;
  candidate.model = model;
  candidate.fit.u = start;
  const auto on_all = [&](const std::vector<double>& u) { return likelihood.slope(u, by_spectrum(u).information); };
  polish(on_all, model, model.ranges(likelihood.scale()), excess_curvature(by_spectrum, start),
         {.tolerance = kTolerance, .steps = kSteps, .learns = true}, candidate.fit);
  candidate.compared_log_likelihood = likelihood.value(candidate.fit.u).at_mean;
  candidate.on_all_samples = true;
  score(likelihood, by_spectrum(candidate.fit.u).information, candidate);
  if (options.held_out || options.criterion == Criterion::kHeldOut)
    candidate.held_out = held_out_score(records, model, candidate.fit.u);
  return candidate;
}

}  // namespace coast::noise
