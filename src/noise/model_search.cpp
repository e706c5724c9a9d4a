#include "model_search.hpp"

#include <algorithm>
#include <optional>

#include "candidate.hpp"
#include "full_fit.hpp"
#include "kalman/fixed_model.hpp"
#include "refinement.hpp"
#include "spectral_step.hpp"
#include "stated_sum.hpp"

namespace coast::noise {

namespace {

std::vector<const Estimable*> named(const std::vector<std::string>& names) {
  std::vector<const Estimable*> processes;
  for (const std::string& name : names) processes.push_back(&estimable(name));
  return processes;
}

/// Slow processes in one order, independent of the order of addition: a sum has one name.
SumModel in_one_order(std::vector<const Estimable*> processes, Mean mean) {
  const std::vector<const Estimable*> order = named({"gauss_markov", "random_walk", "flicker", "quantisation"});
  const auto place = [&](const Estimable* process) { return std::ranges::find(order, process) - order.begin(); };
  std::vector<const Estimable*> slow;
  for (const Estimable* process : processes)
    if (std::ranges::count(order, process) > 0) slow.push_back(process);
  std::ranges::stable_sort(slow, {}, place);
  auto next = slow.begin();
  for (const Estimable*& process : processes)
    if (std::ranges::count(order, process) > 0) process = *next++;
  return {processes, mean};
}

/// The possible bases of a sum, from white noise up.
std::vector<const Estimable*> base_ladder() {
  return named({"white_noise", "ar(1)", "ar(2)", "ar(3)", "ar(4)"});
}

/// Stepwise: the best of the next larger sums as long as one is better, then of the next smaller ones. A sum is first fitted
/// to the spectrum, which costs little: if that result is hopeless, the samples are not used.
class Search {
 public:
  Search(const std::vector<StaticSignal>& records, const AllanCurve& curve, const CalibrationOptions& options)
      : records_(records), curve_(curve), options_(options) {
    const Likelihood likelihood(records, SumModel(named({"white_noise"}), Mean::kLevel));
    spectrum_ = spectrum_of(likelihood.records());
    scale_ = likelihood.scale();
  }

  std::vector<Candidate> run() {
    const SumModel white(named({"white_noise"}), Mean::kLevel);
    tried_.push_back(fit_candidate(records_, curve_, white, {}));
    held_out(tried_.back());
    std::size_t best = 0;
    for (bool growing = true; growing;) growing = step(larger(tried_[best].model, options_), best);
    for (bool shrinking = true; shrinking;) shrinking = step(smaller(tried_[best].model), best);
    // The process added first is not always the best.
    for (bool changing = true; changing;) changing = step(exchanged(tried_[best].model, options_), best);
    return std::move(tried_);
  }

 private:
  bool step(const std::vector<SumModel>& sums, std::size_t& best) {
    const std::size_t before = best;
    SpectralStep from{tried_[best].model, tried_[best].fit.u};
    climb(spectrum_, from.model.ranges(scale_), from);
    for (const SumModel& sum : sums) {
      const std::optional<std::size_t> at = fit(sum, from, before);
      if (at && better(tried_[*at], tried_[best], options_.criterion)) best = *at;
    }
    return best != before;
  }

  /// Index of the sum in the table, fitted if it was not; for a sum with silent processes, that of the sum without them.
  /// None if the spectrum shows that it is hopeless.
  std::optional<std::size_t> fit(const SumModel& model, const SpectralStep& from, std::size_t best) {
    for (std::size_t i = 0; i < tried_.size(); ++i)
      if (tried_[i].model.name() == model.name()) return tried_[i].degenerate ? without_silent(i) : i;
    constexpr double kUsual = 22.0;  // sums that a search fits
    if (options_.progress)
      options_.progress("fitting sums of processes", kSearchShare * std::min(1.0, static_cast<double>(tried_.size()) / kUsual));
    const std::vector<Interval> ranges = model.ranges(scale_);
    SpectralStep climbed{model, step_from(from, model, spectrum_, ranges)};
    climb(spectrum_, ranges, climbed);
    if (hopeless(climbed, from)) return {};
    constexpr double kSmall = 10.0;  // below the upper end of a variance's range, in logarithms
    const std::vector<double> shared = shared_start(tried_[best].model, tried_[best].fit.u, model, ranges, kSmall);
    tried_.push_back(fit_on_extracts(records_, spectrum_, model, {lifted(climbed.u, model, ranges), shared}));
    if (!tried_.back().degenerate) held_out(tried_.back());
    return tried_.back().degenerate ? without_silent(tried_.size() - 1) : tried_.size() - 1;
  }

  /// For fast processes the spectrum has as much information as the samples, for slow ones less, for a random walk least.
  static bool hopeless(const SpectralStep& step, const SpectralStep& from) {
    constexpr double kFast = 2.0;  // of log-likelihood, that a process has to gain: half of the criterion's
    constexpr double kSlow = 0.5;
    constexpr double kMost = 25.0;  // that another sum may lose
    const std::vector<const Estimable*> before = processes_of(from.model);
    const std::vector<const Estimable*> now = processes_of(step.model);
    const auto joined = [&](const char* name) {
      return std::ranges::count(now, &estimable(name)) > std::ranges::count(before, &estimable(name));
    };
    const bool filter = base_of(step.model) != nullptr && base_of(from.model) != nullptr &&
                        base_of(step.model)->process != base_of(from.model)->process;
    double least = -kMost;
    if (joined("gauss_markov") || joined("flicker")) least = kSlow;
    if (joined("quantisation") || filter) least = kFast;
    return step.log_likelihood < from.log_likelihood + least;
  }
  /// Variances near zero have no slope in their logarithm.
  static std::vector<double> lifted(std::vector<double> u, const SumModel& model, const std::vector<Interval>& ranges) {
    constexpr double kNothing = 15.0;  // the range spans 32
    constexpr double kSmall = 13.0;    // below its upper end
    for (std::size_t i = 0; i < u.size(); ++i)
      if (model.parameter(i).kind == ParameterInfo::Kind::kVariance && u[i] < ranges[i].lower + kNothing)
        u[i] = ranges[i].upper - kSmall;
    return u;
  }
  void held_out(Candidate& candidate) const {
    if (options_.held_out || options_.criterion == Criterion::kHeldOut)
      candidate.held_out = held_out_score(records_, candidate.model, candidate.fit.u);
  }
  std::size_t without_silent(std::size_t at) {
    const std::optional<SumModel> rest = reduced(records_, tried_[at]);
    if (!rest) return at;
    const std::optional<std::size_t> fitted = fit(*rest, {tried_[at].model, tried_[at].fit.u}, at);
    if (!fitted) return at;
    const std::size_t found = *fitted;
    // A process without effect does not change the likelihood.
    tried_[at].compared_log_likelihood = tried_[found].compared_log_likelihood;
    score_again(Likelihood(records_, tried_[at].model), tried_[at]);
    return found;
  }

  const std::vector<StaticSignal>& records_;
  const AllanCurve& curve_;
  const CalibrationOptions& options_;
  Spectrum spectrum_;
  SignalScale scale_;
  std::vector<Candidate> tried_;
};

/// The search stops once it can choose. A short record's best is maximised fully, other maxima are searched for.
void polish_best(const std::vector<StaticSignal>& records, const CalibrationOptions& options, std::vector<Candidate>& tried) {
  Candidate& best = tried[choose(tried, options.criterion)];
  const Likelihood likelihood(records, best.model);
  const ShortLikelihood shortened(likelihood);
  if (!shortened.is_whole()) return;
  Fit fit = fit_maximum_likelihood(likelihood, best.fit.u);
  if (!(fit.log_likelihood > best.fit.log_likelihood)) return;
  best.fit = std::move(fit);
  complete(likelihood, shortened, best);
}

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
    sums.push_back(in_one_order(processes, model.mean()));
  };
  if (has("gauss_markov") < options.most_gauss_markov) with("gauss_markov");
  if (has("random_walk") == 0) with("random_walk");
  if (has("quantisation") == 0) with("quantisation");
  if (has("flicker") == 0) with("flicker");
  if (model.mean() != Mean::kLevelAndDrift) sums.emplace_back(now, Mean::kLevelAndDrift);
  const SumModel::Term* base = base_of(model);
  const std::vector<const Estimable*> ladder = base_ladder();
  if (base != nullptr && base->process != ladder.back()) {
    std::vector<const Estimable*> processes = now;
    *std::ranges::find(processes, base->process) = *(std::ranges::find(ladder, base->process) + 1);
    sums.emplace_back(processes, model.mean());
  }
  std::erase_if(sums, [](const SumModel& sum) {
    const bool crowded = std::ranges::count(processes_of(sum), &estimable("flicker")) > 0 && !sum.has_averages();
    return crowded || sum.states() > kMostStates || sum.parameters() > kMostParameters;
  });
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

std::vector<SumModel> exchanged(const SumModel& model, const CalibrationOptions& options) {
  const std::vector<const Estimable*> now = processes_of(model);
  const std::vector<const Estimable*>& slow = slow_processes();
  std::vector<SumModel> sums;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (std::ranges::count(slow, now[i]) == 0) continue;
    for (const Estimable* other : slow) {
      const int most = other == slow.front() ? options.most_gauss_markov : 1;
      if (other == now[i] || std::ranges::count(now, other) >= most) continue;
      std::vector<const Estimable*> processes = now;
      processes[i] = other;
      SumModel sum = in_one_order(processes, model.mean());
      if (sum.states() <= kMostStates && sum.has_averages()) sums.push_back(std::move(sum));
    }
  }
  return sums;
}

std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                      const CalibrationOptions& options) {
  if (options.processes.empty()) {
    std::vector<Candidate> tried = Search(records, curve, options).run();
    refine(records, options, tried);
    polish_best(records, options, tried);
    return tried;
  }
  return {fit_stated(records, curve, SumModel(named(options.processes), options.mean), options)};
}

}  // namespace coast::noise
