#include <algorithm>
#include <cmath>

#include "search/moves/moves.hpp"
#include "search/told.hpp"

namespace coast::diagnose {

namespace {

constexpr std::size_t kMostRandom = 4;

FilteredMission filtered(const ExplainedRun& run) {
  return {run.input(), run.mission().layout(), run.mission().log_likelihood()};
}

const NoiseSuspicion* first_of(const NoiseSuspicions& suspected, const Exclusions& excluded) {
  const NoiseSuspicion* first = nullptr;
  for (const NoiseSuspicion& s : suspected.all)
    if (s.p_value < kNoiseFalseAlarm && !excluded.excludes(s.noise) &&
        (first == nullptr || s.likelihood_ratio > first->likelihood_ratio))
      first = &s;
  return first;
}

const NoiseSuspicion* strongest(const NoiseSuspicions& suspected, const NoiseEffect& effect, const AddedNoise& beside) {
  const NoiseSuspicion* best = nullptr;
  for (const NoiseSuspicion& s : suspected.all)
    if (s.noise.effect == &effect && effect.site == beside.effect->site && s.noise.axis == beside.axis &&
        (best == nullptr || s.likelihood_ratio > best->likelihood_ratio))
      best = &s;
  return best;
}

/// A selected effect that is found again, because the noise was fitted anew, is one effect: the run without
/// it, and the fit of both together.
struct Merged {
  RunPtr run;
  std::optional<std::size_t> index;  ///< of the selected one; none: a new one
  FittedEffect fit;
};
Merged merged(const FittedEffect& fit, const State& state, Runs& runs) {
  const std::vector<AddedNoise>& selected = state.explanation.random;
  const auto same = std::ranges::find_if(
      selected, [&](const AddedNoise& one) { return one.effect == fit.noise.effect && one.axis == fit.noise.axis; });
  if (same == selected.end()) return {state.run, {}, fit};
  Explanation without = state.explanation;
  without.random.erase(without.random.begin() + (same - selected.begin()));
  const RunPtr run = runs.about(without, state.run);
  AddedNoise both = fit.noise;
  both.root = std::hypot(both.root, same->root);
  return {run, static_cast<std::size_t>(same - selected.begin()), fitted_effect(both, filtered(*run))};
}

/// Every random effect of the axis at its likeliest size and time, in decreasing order of plausibility.
std::vector<FittedEffect> rivals(const Merged& first, const NoiseSuspicion& suspicion, const NoiseSuspicions& suspected) {
  std::vector<FittedEffect> fits{fitted_in_time(first.fit, filtered(*first.run))};
  for (const NoiseEffect& effect : noise_catalogue()) {
    const NoiseSuspicion* s = strongest(suspected, effect, suspicion.noise);
    if (s == nullptr || &effect == suspicion.noise.effect) continue;
    fits.push_back(fitted_in_time(fitted_effect(s->noise, filtered(*first.run)), filtered(*first.run)));
  }
  std::ranges::sort(fits, std::ranges::greater{}, [](const FittedEffect& fit) { return evidence_of(fit); });
  return fits;
}

Proposal selection_of(const Merged& first, const std::vector<FittedEffect>& fits, double p_value, const State& state) {
  Explanation explanation = first.index ? first.run->explanation() : state.explanation;
  explanation.random.push_back(fits.front().noise);
  return {.explanation = std::move(explanation),
          .about = first.run,
          .accept = [index = first.index, finding = noise_finding_of(fits, p_value, state)](State& next, double) {
            std::vector<NoiseFinding>& told = next.account.random;
            if (index) told.erase(told.begin() + static_cast<std::ptrdiff_t>(*index));
            told.push_back(finding);
            next.seen.beaten.clear();
          }};
}

}  // namespace

Proposals add_random_effect(Look& look) {
  if (look.takes_means_first()) return {};
  const std::optional<FittedNoise>& stated = look.stated_noise();
  const State& state = look.state();
  if (state.explanation.random.size() >= kMostRandom) return {};
  const NoiseSuspicions suspected = noise_suspicions(look.examination(), look.run().mission());
  const NoiseSuspicion* first = first_of(suspected, state.excluded);
  if (first == nullptr) return {.reject = [](State& next) { next.seen.beaten.clear(); }};
  const FittedEffect fit = fitted_effect(first->noise, filtered(look.run()));
  const double p_value = suspected.chance.p_value(2.0 * std::max(0.0, fit.gain));
  const double gain = fit.gain - std::log(suspected.chance.count);
  const bool is_chance = p_value > kNoiseFalseAlarm;
  if (is_chance || gain <= std::max(look.form_gain(), stated ? stated->gain() : 0.0) ||
      !look.candidates().evidence_is_exceeded_by(evidence_of(fit)))
    return {.reject = [fit, is_chance](State& next) {
      if (is_chance) next.excluded.random.push_back(fit.noise);
      next.seen.beaten = {fit};
    }};
  const Merged merge = merged(fit, state, look.context().runs);
  return {.tries = {selection_of(merge, rivals(merge, *first, suspected), p_value, state)},
          .reject = [fit](State& next) { next.excluded.random.push_back(fit.noise); },
          .looks_again = true,
          .is_noise = true};
}

}  // namespace coast::diagnose
