#include "model_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/record/error.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

/// Processes that the record does not want: without its variance the likelihood is the same, or its rate has gone to where it
/// is another process.
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

void score(const Likelihood& likelihood, Candidate& candidate) {
  const double n = likelihood.samples();
  candidate.parameters = static_cast<int>(candidate.model.parameters()) +
                         coefficients(candidate.model.mean()) * static_cast<int>(likelihood.records().size());
  const auto k = static_cast<double>(candidate.parameters);
  candidate.bic = -2.0 * candidate.compared_log_likelihood + k * std::log(n);
  candidate.aicc = -2.0 * candidate.compared_log_likelihood + 2.0 * k + 2.0 * k * (k + 1.0) / std::max(1.0, n - k - 1.0);
}

/// Each half scored with what the other was fitted to.
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

std::vector<const Estimable*> named(const std::vector<std::string>& names) {
  std::vector<const Estimable*> processes;
  for (const std::string& name : names) processes.push_back(&estimable(name));
  return processes;
}

std::vector<const Estimable*> processes_of(const SumModel& model) {
  std::vector<const Estimable*> processes;
  for (const SumModel::Term& term : model.terms()) processes.push_back(term.process);
  return processes;
}

/// The next larger sums: one more process, a drift, or an autoregression one order higher in the place of white noise.
std::vector<SumModel> larger(const SumModel& model, const CalibrationOptions& options) {
  const std::vector<const Estimable*> now = processes_of(model);
  const auto has = [&](const char* name) { return std::ranges::count(now, &estimable(name)); };
  std::vector<SumModel> sums;
  const auto with = [&](const char* name) {
    std::vector<const Estimable*> processes = now;
    processes.push_back(&estimable(name));
    sums.emplace_back(processes, model.mean());
  };
  if (has("gauss_markov") < options.most_gauss_markov) with("gauss_markov");
  if (has("random_walk") == 0) with("random_walk");
  if (has("quantisation") == 0) with("quantisation");
  if (model.mean() != Mean::kLevelAndDrift) sums.emplace_back(now, Mean::kLevelAndDrift);
  const std::vector<const Estimable*> bases = named({"white_noise", "ar(1)", "ar(2)", "ar(3)"});
  for (std::size_t b = 0; b + 1 < bases.size(); ++b) {
    if (std::ranges::count(now, bases[b]) == 0) continue;
    std::vector<const Estimable*> processes = now;
    std::ranges::replace(processes, bases[b], bases[b + 1]);
    sums.emplace_back(processes, model.mean());
  }
  return sums;
}

/// The next smaller sums.
std::vector<SumModel> smaller(const SumModel& model) {
  const std::vector<const Estimable*> now = processes_of(model);
  std::vector<SumModel> sums;
  for (std::size_t i = 0; i < now.size() && now.size() > 1; ++i) {
    std::vector<const Estimable*> processes = now;
    processes.erase(processes.begin() + static_cast<std::ptrdiff_t>(i));
    sums.emplace_back(processes, model.mean());
  }
  if (model.mean() == Mean::kLevelAndDrift) sums.emplace_back(now, Mean::kLevel);
  return sums;
}

/// What other sums found for the processes that they share with this one, and the middle of the range for the others.
std::vector<std::vector<double>> starts_from(const std::vector<Candidate>& others, const SumModel& model,
                                             const SignalScale& scale) {
  std::vector<std::vector<double>> starts;
  const std::vector<Interval> ranges = model.ranges(scale);
  for (const Candidate& candidate : others) {
    std::vector<double> u(model.parameters());
    for (std::size_t i = 0; i < u.size(); ++i) {
      const bool variance = model.parameter(i).kind == ParameterInfo::Kind::kVariance;
      u[i] = variance ? ranges[i].upper - 10.0 : 0.5 * (ranges[i].lower + ranges[i].upper);
    }
    std::vector<bool> taken(model.terms().size(), false);
    for (const SumModel::Term& from : candidate.model.terms())
      for (std::size_t t = 0; t < model.terms().size(); ++t) {
        const SumModel::Term& to = model.terms()[t];
        if (taken[t] || to.process != from.process) continue;
        std::copy_n(candidate.fit.u.begin() + static_cast<std::ptrdiff_t>(from.parameter), from.parameters,
                    u.begin() + static_cast<std::ptrdiff_t>(to.parameter));
        taken[t] = true;
        break;
      }
    starts.push_back(std::move(u));
  }
  return starts;
}

/// A sum without the processes that say nothing of a fit; nothing where all of them speak.
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

/// Stepwise: the best of the next larger sums as long as one is better, then of the next smaller ones.
class Search {
 public:
  Search(const std::vector<StaticSignal>& records, const AllanCurve& curve, const CalibrationOptions& options)
      : records_(records), curve_(curve), options_(options) {}

  std::vector<Candidate> run() {
    std::size_t best = fit(SumModel(named({"white_noise"}), Mean::kLevel));
    for (bool growing = true; growing;) growing = step(larger(tried_[best].model, options_), best);
    for (bool shrinking = true; shrinking;) shrinking = step(smaller(tried_[best].model), best);
    return std::move(tried_);
  }

 private:
  bool step(const std::vector<SumModel>& sums, std::size_t& best) {
    const std::size_t before = best;
    for (const SumModel& sum : sums) {
      const std::size_t at = fit(sum);
      if (better(tried_[at], tried_[best], options_.criterion)) best = at;
    }
    return best != before;
  }

  /// The place of the sum in the table, fitted if it was not; of a sum with silent processes, that of the sum without them.
  std::size_t fit(const SumModel& model) {
    for (std::size_t i = 0; i < tried_.size(); ++i)
      if (tried_[i].model.name() == model.name()) return tried_[i].degenerate ? without_silent(i) : i;
    if (options_.progress)
      options_.progress("fitting sums of processes", 1.0 - 1.0 / (1.0 + 0.05 * static_cast<double>(tried_.size())));
    const SignalScale scale = Likelihood(records_, model).scale();
    tried_.push_back(fit_candidate(records_, curve_, model, starts_from(tried_, model, scale)));
    Candidate& last = tried_.back();
    if (!last.degenerate && (options_.held_out || options_.criterion == Criterion::kHeldOut))
      last.held_out = held_out_score(records_, model, last.fit.u);
    return last.degenerate ? without_silent(tried_.size() - 1) : tried_.size() - 1;
  }
  std::size_t without_silent(std::size_t at) {
    const std::optional<SumModel> rest = reduced(records_, tried_[at]);
    if (!rest) return at;
    const std::size_t found = fit(*rest);
    // What is not there leaves the likelihood where it was.
    tried_[at].compared_log_likelihood = tried_[found].compared_log_likelihood;
    score(Likelihood(records_, tried_[at].model), tried_[at]);
    return found;
  }

  const std::vector<StaticSignal>& records_;
  const AllanCurve& curve_;
  const CalibrationOptions& options_;
  std::vector<Candidate> tried_;
};

}  // namespace

Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                        const std::vector<std::vector<double>>& starts) {
  Candidate candidate;
  candidate.model = model;
  const Likelihood likelihood(records, model);
  const ShortLikelihood shortened(likelihood);
  const SignalScale scale = likelihood.scale();
  std::vector<double> best = fit_curve(curve, model, scale, CurveFit::kWaveletMoments);
  double value = shortened.value(best);
  for (const std::vector<double>& start : starts) {
    const double there = shortened.value(start);
    if (!(there > value)) continue;
    value = there;
    best = start;
  }
  candidate.fit = fit_maximum_likelihood(likelihood, best, {.polished = shortened.is_whole()});
  candidate.degenerate = std::ranges::count(silent_terms(shortened, model.ranges(scale), model, candidate.fit.u), true) > 0;
  candidate.compared_log_likelihood = shortened.at_mean(candidate.fit.u);
  score(likelihood, candidate);
  return candidate;
}

std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                      const CalibrationOptions& options) {
  if (options.processes.empty()) return Search(records, curve, options).run();
  std::vector<Candidate> stated{fit_candidate(records, curve, SumModel(named(options.processes), options.mean), {})};
  if (options.held_out || options.criterion == Criterion::kHeldOut)
    stated.front().held_out = held_out_score(records, stated.front().model, stated.front().fit.u);
  return stated;
}

bool better(const Candidate& a, const Candidate& b, Criterion criterion) {
  const auto cost = [&](const Candidate& c) {
    if (!std::isfinite(c.compared_log_likelihood)) return std::numeric_limits<double>::infinity();
    if (criterion == Criterion::kHeldOut) return c.held_out ? -*c.held_out : std::numeric_limits<double>::infinity();
    return criterion == Criterion::kBic ? c.bic : c.aicc;
  };
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
