#include "model_search.hpp"

#include <algorithm>

#include "candidate.hpp"
#include "kalman/fixed_model.hpp"
#include "refinement.hpp"

namespace coast::noise {

namespace {

std::vector<const Estimable*> named(const std::vector<std::string>& names) {
  std::vector<const Estimable*> processes;
  for (const std::string& name : names) processes.push_back(&estimable(name));
  return processes;
}

/// From white noise up: what the base of a sum may be.
std::vector<const Estimable*> base_ladder() {
  return named({"white_noise", "ar(1)", "ar(2)", "ar(3)", "ar(4)"});
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

std::vector<const Estimable*> processes_of(const SumModel& model) {
  std::vector<const Estimable*> processes;
  for (const SumModel::Term& term : model.terms()) processes.push_back(term.process);
  return processes;
}

const SumModel::Term* base_of(const SumModel& model) {
  const std::vector<const Estimable*> ladder = base_ladder();
  for (const SumModel::Term& term : model.terms())
    if (std::ranges::count(ladder, term.process) > 0) return &term;
  return nullptr;
}

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
  const SumModel::Term* base = base_of(model);
  const std::vector<const Estimable*> ladder = base_ladder();
  if (base != nullptr && base->process != ladder.back()) {
    std::vector<const Estimable*> processes = now;
    *std::ranges::find(processes, base->process) = *(std::ranges::find(ladder, base->process) + 1);
    sums.emplace_back(processes, model.mean());
  }
  std::erase_if(sums, [](const SumModel& sum) { return sum.states() > kMostStates || sum.parameters() > kMostParameters; });
  return sums;
}

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

std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                      const CalibrationOptions& options) {
  if (options.processes.empty()) {
    std::vector<Candidate> tried = Search(records, curve, options).run();
    refine(records, options, tried);
    return tried;
  }
  std::vector<Candidate> stated{fit_candidate(records, curve, SumModel(named(options.processes), options.mean), {})};
  if (options.held_out || options.criterion == Criterion::kHeldOut)
    stated.front().held_out = held_out_score(records, stated.front().model, stated.front().fit.u);
  return stated;
}

}  // namespace coast::noise
