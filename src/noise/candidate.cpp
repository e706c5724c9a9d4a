#include "candidate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/record/error.hpp"
#include "polish.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

namespace {

/// Processes without effect on the record's likelihood: it is the same without the variance, or at the rate's limit the
/// process equals another one.
std::vector<bool> silent_terms(const ShortLikelihood& likelihood, const std::vector<Interval>& ranges, const SumModel& model,
                               const std::vector<double>& u) {
  constexpr double kAtEnd = 1e-6;
  constexpr double kNothing = 0.02;  // of log-likelihood
  const double value = likelihood.value(u);
  std::vector<bool> silent;
  for (const SumModel::Term& term : model.terms()) {
    bool says_nothing = false;
    for (std::size_t i = term.parameter; i < term.parameter + term.parameters; ++i) {
      const ParameterInfo::Kind kind = model.parameter(i).kind;
      says_nothing |=
          kind == ParameterInfo::Kind::kRate && (u[i] < ranges[i].lower + kAtEnd || u[i] > ranges[i].upper - kAtEnd);
      if (kind != ParameterInfo::Kind::kVariance) continue;
      std::vector<double> without = u;
      without[i] = ranges[i].lower;
      says_nothing |= value - likelihood.value(without) < kNothing;
    }
    silent.push_back(says_nothing);
  }
  return silent;
}

}  // namespace

const std::vector<const Estimable*>& slow_processes() {
  static const std::vector<const Estimable*> slow{&estimable("gauss_markov"), &estimable("random_walk"), &estimable("flicker")};
  return slow;
}

double penalty(const SumModel& model, const std::vector<double>& independent, double samples, double least_gain) {
  double sum = 0.0;
  for (const SumModel::Term& term : model.terms()) {
    const bool slow = std::ranges::count(slow_processes(), term.process) > 0;
    if (term.process == &estimable("flicker")) sum += least_gain;
    for (std::size_t i = term.parameter; i < term.parameter + term.parameters; ++i)
      sum += slow ? std::max(least_gain, std::log(std::min(independent[i], samples))) : std::log(samples);
  }
  return sum;
}

std::vector<double> independent_squares(const Eigen::MatrixXd& information) {
  const Eigen::MatrixXd covariance = cramer_rao(information);
  std::vector<double> squares;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) squares.push_back(covariance(i, i) > 0.0 ? 2.0 / covariance(i, i) : 0.0);
  return squares;
}

void score(const Likelihood& likelihood, const Eigen::MatrixXd& information, Candidate& candidate) {
  candidate.independent = independent_squares(information);
  score_again(likelihood, candidate);
}

void score_again(const Likelihood& likelihood, Candidate& candidate) {
  const double n = likelihood.samples();
  const int means = coefficients(candidate.model.mean()) * static_cast<int>(likelihood.records().size());
  candidate.parameters = static_cast<int>(candidate.model.parameters()) + means;
  const auto k = static_cast<double>(candidate.parameters);
  candidate.bic =
      -2.0 * candidate.compared_log_likelihood + penalty(candidate.model, candidate.independent, n) + means * std::log(n);
  candidate.aicc = -2.0 * candidate.compared_log_likelihood + 2.0 * k + 2.0 * k * (k + 1.0) / std::max(1.0, n - k - 1.0);
}

double held_out_score(const std::vector<StaticSignal>& records, const SumModel& model, const std::vector<double>& u) {
  double sum = 0.0;
  double samples = 0.0;
  for (const StaticSignal& record : records) {
    const std::uint64_t half = record.length() / 2;
    const StaticSignal parts[] = {part_of(record, 0, half), part_of(record, half, record.length() - half)};
    for (const std::size_t fitted : {std::size_t{0}, std::size_t{1}}) {
      const Fit fit = fit_maximum_likelihood(Likelihood({parts[fitted]}, model), u);
      const Likelihood other({parts[1 - fitted]}, model);
      sum += other.value(fit.u).at_mean;
      samples += other.samples();
    }
  }
  return sum / samples;
}

void complete(const Likelihood& likelihood, const ShortLikelihood& shortened, Candidate& candidate) {
  const SumModel& model = candidate.model;
  const std::vector<bool> silent = silent_terms(shortened, model.ranges(likelihood.scale()), model, candidate.fit.u);
  candidate.degenerate = std::ranges::count(silent, true) > 0;
  candidate.compared_log_likelihood = shortened.at_mean(candidate.fit.u);
  candidate.on_all_samples = shortened.is_whole();
  score(likelihood, shortened.slope(candidate.fit.u).information, candidate);
}

Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                        const std::vector<std::vector<double>>& starts) {
  Candidate candidate;
  candidate.model = model;
  const Likelihood likelihood(records, model);
  const ShortLikelihood shortened(likelihood);
  std::vector<double> best = fit_curve(curve, model, likelihood.scale(), CurveFit::kWaveletMoments);
  double value = shortened.value(best);
  for (const std::vector<double>& start : starts) {
    const double there = shortened.value(start);
    if (!(there > value)) continue;
    value = there;
    best = start;
  }
  candidate.fit = fit_maximum_likelihood(likelihood, best, {.polished = shortened.is_whole()});
  complete(likelihood, shortened, candidate);
  return candidate;
}

Candidate fit_from(const std::vector<StaticSignal>& records, const SumModel& model, const std::vector<double>& start) {
  Candidate candidate;
  candidate.model = model;
  const Likelihood likelihood(records, model);
  const ShortLikelihood shortened(likelihood);
  candidate.fit.u = start;
  polish([&](const std::vector<double>& u) { return shortened.slope(u); }, model, model.ranges(likelihood.scale()), {}, {},
         candidate.fit);
  complete(likelihood, shortened, candidate);
  return candidate;
}

std::optional<SumModel> reduced(const std::vector<StaticSignal>& records, const Candidate& candidate) {
  const SumModel& model = candidate.model;
  const Likelihood likelihood(records, model);
  const std::vector<bool> silent =
      silent_terms(ShortLikelihood(likelihood), model.ranges(likelihood.scale()), model, candidate.fit.u);
  std::vector<const Estimable*> processes;
  for (std::size_t t = 0; t < silent.size(); ++t)
    if (!silent[t]) processes.push_back(model.terms()[t].process);
  if (processes.empty() || processes.size() == silent.size()) return {};
  return SumModel(processes, model.mean());
}

bool better(const Candidate& a, const Candidate& b, Criterion criterion) {
  const auto cost = [&](const Candidate& c) {
    if (!std::isfinite(c.compared_log_likelihood)) return std::numeric_limits<double>::infinity();
    if (criterion == Criterion::kHeldOut) return c.held_out ? -*c.held_out : std::numeric_limits<double>::infinity();
    return criterion == Criterion::kBic ? c.bic : c.aicc;
  };
  if (a.on_all_samples != b.on_all_samples) return a.on_all_samples;
  return a.degenerate != b.degenerate ? b.degenerate : cost(a) < cost(b);
}

std::size_t choose(const std::vector<Candidate>& candidates, Criterion criterion) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (better(candidates[i], candidates[best], criterion)) best = i;
  if (!std::isfinite(candidates[best].compared_log_likelihood))
    throw NumericalError("no sum of processes has a finite likelihood", "", "is the signal constant?");
  return best;
}

}  // namespace coast::noise
