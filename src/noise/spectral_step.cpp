#include "spectral_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bounded_search.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

/// Parameters of an autoregression one order higher for the same series: a last partial autocorrelation of zero.
void raise_order(const SumModel::Term& from, std::span<const double> u, double interval, std::span<double> raised) {
  std::copy_n(u.begin(), u.size() - 1, raised.begin());
  raised[raised.size() - 2] = 0.0;
  raised[raised.size() - 1] = from.states > 0 ? u.back() : u.back() - std::log(interval);  // white noise is given as density
}

/// Parameters of an added process: the best of a coarse grid, once the others have begun to adapt.
void place(const SumModel& model, const SumModel::Term& added, const Spectrum& spectrum, const std::vector<Interval>& ranges,
           std::vector<double>& u) {
  std::vector<std::vector<double>> trials{u};
  for (std::size_t i = added.parameter; i < added.parameter + added.parameters; ++i) {
    std::vector<double> values;
    if (model.parameter(i).kind == ParameterInfo::Kind::kVariance)
      values = {ranges[i].upper - 3.0, ranges[i].upper - 7.0, ranges[i].upper - 11.0};
    else
      for (int k = 0; k < 8; ++k) values.push_back(ranges[i].lower + (ranges[i].upper - ranges[i].lower) * (k + 0.5) / 8.0);
    std::vector<std::vector<double>> more;
    for (const std::vector<double>& trial : trials)
      for (const double value : values) {
        more.push_back(trial);
        more.back()[i] = value;
      }
    trials = std::move(more);
  }
  double best = -std::numeric_limits<double>::infinity();
  for (const std::vector<double>& trial : trials) {
    constexpr int kBegun = 6;
    Fit fit;
    fit.u = trial;
    polish([&](const std::vector<double>& at) { return spectral_slope(spectrum, model, at); }, model, ranges, {},
           {.tolerance = 0.1, .steps = kBegun}, fit);
    if (!(fit.log_likelihood > best)) continue;
    best = fit.log_likelihood;
    u = fit.u;
  }
}

}  // namespace

std::span<const double> values_of(const std::vector<double>& u, const SumModel::Term& term) {
  return std::span(u).subspan(term.parameter, term.parameters);
}

std::vector<double> step_from(const SpectralStep& now, const SumModel& model, const Spectrum& spectrum,
                              const std::vector<Interval>& ranges) {
  std::vector<double> u(model.parameters(), 0.0);
  std::vector<bool> used(now.model.terms().size(), false);
  const SumModel::Term* fresh = nullptr;
  for (const SumModel::Term& term : model.terms()) {
    std::size_t from = 0;
    while (from < used.size() && (used[from] || now.model.terms()[from].process != term.process)) ++from;
    if (from == used.size()) {
      fresh = &term;
      continue;
    }
    used[from] = true;
    std::ranges::copy(values_of(now.u, now.model.terms()[from]), u.begin() + static_cast<std::ptrdiff_t>(term.parameter));
  }
  if (fresh == nullptr) return u;
  const auto gone = static_cast<std::size_t>(std::ranges::find(used, false) - used.begin());
  const bool raised = gone < used.size() && fresh->process->symbol().starts_with("AR");
  if (raised)
    raise_order(now.model.terms()[gone], values_of(now.u, now.model.terms()[gone]), spectrum.interval,
                std::span(u).subspan(fresh->parameter, fresh->parameters));
  else
    place(model, *fresh, spectrum, ranges, u);
  return u;
}

void climb(const Spectrum& spectrum, const std::vector<Interval>& box, SpectralStep& step) {
  constexpr int kIterations = 40;
  Fit fit;
  fit.u = search_within(step.u, box, 1e-2, kIterations, [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
            const LikelihoodSlope at = spectral_slope(spectrum, step.model, u);
            gradient = -at.gradient;
            return -at.log_likelihood;
          }).u;
  polish([&](const std::vector<double>& u) { return spectral_slope(spectrum, step.model, u); }, step.model, box, {},
         {.tolerance = 1e-3, .steps = kIterations}, fit);
  step.u = fit.u;
  step.log_likelihood = fit.log_likelihood;
}

}  // namespace coast::noise
