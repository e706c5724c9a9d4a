#include "search/review.hpp"

#include <algorithm>
#include <utility>

#include "search/selection.hpp"
#include "search/sizes.hpp"

namespace coast::diagnose {

namespace {

/// Result for one effect.
struct Outcome {
  enum class Kind { kStays, kSelectedAgain, kReplaced };
  State state;
  Kind kind = Kind::kStays;
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
      return {*std::move(next), Outcome::Kind::kReplaced};
    }
    without.excluded.rejected.push_back(best.hypothesis);
  }
  Outcome outcome{state, Outcome::Kind::kStays};
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

Outcome effect_reviewed(const State& state, std::size_t index, Context& context) {
  const SelectedEffect effect = state.explanation.effects[index];
  const Effect& kind = *state.account.findings[index].hypothesis.effect;
  const bool has_name = !state.explanation.is_suggested(kind);
  if (!has_name && kind.relation.empty()) return {state, Outcome::Kind::kStays};
  State without = taken_out(state, index, context);
  const double gain = state.run->log_likelihood() - without.run->log_likelihood();
  if (!has_name) return relation_reviewed(state, index, std::move(without), gain, context);
  Candidates candidates(without, context);
  candidates.add_selected(effect.hypothesis, gain);
  if (candidates.empty()) return {std::move(without), Outcome::Kind::kReplaced};
  Suspicion best = candidates.likeliest();
  const bool is_same = best.hypothesis == effect.hypothesis;
  if (is_same) inform(best, effect, gain);
  std::optional<State> next = first_accepted(selections(best, without, candidates, context), without, context);
  if (next) return {*std::move(next), is_same ? Outcome::Kind::kSelectedAgain : Outcome::Kind::kReplaced};
  without.excluded.rejected.push_back(best.hypothesis);
  return {std::move(without), Outcome::Kind::kReplaced};
}

}  // namespace

Reviewed reviewed(State state, Context& context) {
  bool changed = false;
  std::size_t next = 0;  // earlier effects stay; re-selected ones are appended after all others
  for (std::size_t left = state.explanation.effects.size(); left > 0; --left) {
    Outcome outcome = effect_reviewed(state, next, context);
    state = std::move(outcome.state);
    if (outcome.kind == Outcome::Kind::kStays) ++next;
    if (outcome.kind != Outcome::Kind::kReplaced) continue;
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
