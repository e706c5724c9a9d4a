#include "search/review.hpp"

#include <algorithm>
#include <utility>

#include "coast/parallel.hpp"
#include "search/selection.hpp"
#include "search/sizes.hpp"
#include "search/told.hpp"

namespace coast::diagnose {

namespace {

/// Result for one effect.
struct Outcome {
  State state;
  bool replaced = false;
};

bool has_name(const State& state, std::size_t index) {
  return !state.explanation.is_suggested(*state.account.findings[index].hypothesis.effect);
}

/// A line is not reviewed: no effect of the catalogue explains one frequency.
bool is_reviewed(const State& state, std::size_t index) {
  return has_name(state, index) || !state.account.findings[index].hypothesis.effect->relation.empty();
}

/// Runs without one effect each. Most reviews leave the run as it is: the next one's is made at the same time.
class RunsWithout {
 public:
  explicit RunsWithout(Runs& runs) : runs_(&runs) {}

  /// @throws NumericalError  the filter fails
  [[nodiscard]] RunPtr run(const State& state, std::size_t index) {
    if (about_ != state.run || index < first_ || index - first_ >= made_.size()) make(state, index);
    if (RunPtr made = made_[index - first_]) return made;
    return runs_->about(explanation_without(state, index), state.run);  // fails again, and says why
  }

 private:
  static constexpr std::size_t kAtATime = 2;  // whatever the threads are: so is the number of runs

  void make(const State& state, std::size_t index) {
    about_ = state.run;
    first_ = index;
    std::vector<Runs::Request> requests;
    for (std::size_t i = index; i < std::min(index + kAtATime, state.explanation.effects.size()) && is_reviewed(state, i); ++i)
      requests.push_back({explanation_without(state, i), state.run});
    made_ = runs_->try_all(requests);
    coast::parallel_for_each(made_, [](const RunPtr& run) {
      if (run) static_cast<void>(run->scores());
    });
  }

  Runs* runs_;
  RunPtr about_;
  std::size_t first_ = 0;
  std::vector<RunPtr> made_;
};

/// A relation, compared with all effects of the catalogue, one of which replaces it if it explains as much.
/// @param without  the state without it  @param gain  in log-likelihood by it
Outcome relation_reviewed(const State& state, std::size_t index, State without, double gain, Context& context) {
  const Finding& finding = state.account.findings[index];
  without.excluded.rejected.push_back(state.explanation.effects[index].hypothesis);
  Candidates candidates(without, context);
  if (!candidates.empty() && !candidates.gain_is_exceeded_by(gain - finding.price)) {
    const Suspicion best = candidates.likeliest();
    if (std::optional<State> next = first_accepted(selections(best, without, candidates, context), without, context)) {
      const std::vector<EffectPtr>& suggested = state.explanation.suggested;
      next->excluded.forms.push_back(*std::ranges::find(suggested, finding.hypothesis.effect, &EffectPtr::get));
      return {*std::move(next), true};
    }
    without.excluded.rejected.push_back(best.hypothesis);
  }
  Outcome outcome{state};
  outcome.state.excluded = without.excluded;
  return outcome;
}

/// Adds the known gain to the suspicion of an effect.
void inform(Suspicion& s, const SelectedEffect& effect, double gain) {
  constexpr double kNotLinear = 1.3;  // ratio to the score's gain: above it an effect is not to be judged by scores
  s.from = effect.from;
  s.estimate = effect.value;
  if (gain <= kNotLinear * 0.5 * s.likelihood_ratio) return;
  s.log_bayes += gain - 0.5 * s.likelihood_ratio;
  s.likelihood_ratio = 2.0 * gain;
}

/// The state with an effect that is the likeliest still, as it is told among the others.
State confirmed(State state, std::size_t index, const Suspicion& s, double gain, const State& without,
                const Candidates& candidates) {
  Finding& finding = state.account.findings[index];
  const double sd = finding.sd;
  finding = finding_of(s, without.run->hypotheses()[s.hypothesis], without, candidates);
  finding.sd = sd;
  finding.delta_log_likelihood = gain;
  return state;
}

/// @param run  without the effect
Outcome effect_reviewed(const State& state, std::size_t index, RunPtr run, Context& context) {
  const SelectedEffect effect = state.explanation.effects[index];
  State without = taken_out(state, index, std::move(run));
  const double gain = state.run->log_likelihood() - without.run->log_likelihood();
  if (!has_name(state, index)) return relation_reviewed(state, index, std::move(without), gain, context);
  Candidates candidates(without, context);
  candidates.add_selected(effect.hypothesis, gain);
  if (candidates.empty()) return {std::move(without), true};
  Suspicion best = candidates.likeliest();
  if (best.hypothesis == effect.hypothesis) {
    inform(best, effect, gain);
    if (gain >= 0.5 * threshold(without, context)) return {confirmed(state, index, best, gain, without, candidates)};
  }
  std::optional<State> next = first_accepted(selections(best, without, candidates, context), without, context);
  if (next) return {*std::move(next), best.hypothesis != effect.hypothesis};
  without.excluded.rejected.push_back(best.hypothesis);
  return {std::move(without), true};
}

}  // namespace

Reviewed reviewed(State state, Context& context) {
  bool changed = false;
  RunsWithout without(context.runs);
  std::size_t next = 0;  // effects that stay stay in their places; others are appended behind all of them
  for (std::size_t left = state.explanation.effects.size(); left > 0; --left) {
    if (!is_reviewed(state, next)) {
      ++next;
      continue;
    }
    const RunPtr standing = state.run;
    Outcome outcome = effect_reviewed(state, next, without.run(state, next), context);
    state = std::move(outcome.state);
    if (state.run == standing) ++next;  // it stayed
    if (!outcome.replaced) continue;
    changed = true;
    state = without_insignificant(with_settled_sizes(std::move(state), context), context);
    const std::size_t size = state.explanation.effects.size();
    next = std::min(next, size);
    left = std::min(left, size - next + 1);
  }
  if (changed) state.noise.is_behind = true;
  return {std::move(state), changed};
}

}  // namespace coast::diagnose
