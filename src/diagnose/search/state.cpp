#include "search/state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace coast::diagnose {

double Context::false_alarm_of_catalogue() const {
  return std::max(0.5 * options.false_alarm_probability,
                  options.false_alarm_probability - kNoiseFalseAlarm - 2.0 * kFormFalseAlarm);
}

bool Exclusions::excludes(Eigen::Index hypothesis) const {
  const auto has = [&](const std::vector<Eigen::Index>& all) { return std::ranges::find(all, hypothesis) != all.end(); };
  return has(rejected) || has(given_up) || has(exchanged);
}

bool Exclusions::excludes(const Effect& form) const {
  return std::ranges::any_of(forms, [&](const EffectPtr& e) {
    return e->name == form.name && e->site == form.site && e->axes == form.axes && e->relation == form.relation;
  });
}

bool Exclusions::excludes(const AddedNoise& noise) const {
  return std::ranges::any_of(
      random, [&](const AddedNoise& other) { return other.axis == noise.axis && other.effect->site == noise.effect->site; });
}

double log_choices(const State& state) {
  return std::log(static_cast<double>(state.run->hypotheses().size()));
}

double threshold(const State& state, const Context& context) {
  return state.seen.suspicions.chance.quantile(context.false_alarm_of_catalogue());
}

double evidence_of(const State& state) {
  const double parameters = state.account.noise ? static_cast<double>(state.account.noise->fit.names.size()) : 0.0;
  double prices = parameters;
  for_each_selection(state.account, [&](std::size_t first, std::size_t) {
    prices += log_choices(state) + state.account.findings[first].price;
  });
  for (const NoiseFinding& f : state.account.random) prices += price_of_random_effect(f.sd / f.value);
  // A shared bias that is still beyond the error model has a cost that an error model with a larger sigma would not have.
  for (const TurnOn& one : beyond_stated(state.run->mission()))
    prices += state.explanation.is_shared(one) ? -one.gain() : one.price();
  return state.run->log_likelihood() + state.start.standstill - prices;
}

bool is_of_a_line(const Finding& finding) {
  return finding.hypothesis.effect->name == "harmonic_disturbance";
}

std::size_t selected_together(const Account& account, std::size_t first) {
  const Finding& f = account.findings[first];
  const bool has_other = is_of_a_line(f) && first + 1 < account.findings.size();
  return has_other && account.findings[first + 1].hypothesis.effect == f.hypothesis.effect ? 2 : 1;
}

namespace {

void erase_selection(State& state, std::size_t first) {
  const std::size_t count = selected_together(state.account, first);
  const auto at = state.account.findings.begin() + static_cast<std::ptrdiff_t>(first);
  state.account.findings.erase(at, at + static_cast<std::ptrdiff_t>(count));
  state.relation.reset();
}

}  // namespace

Explanation explanation_without(const State& state, std::size_t first) {
  return state.explanation.without(first, selected_together(state.account, first));
}

void note_deviations(State& state, const Movement& step) {
  for (std::size_t i = 0; i < state.account.findings.size(); ++i)
    if (const double sd = step.sd(static_cast<Eigen::Index>(i)); sd > 0.0) state.account.findings[i].sd = sd;
}

State with_run(State state, RunPtr run) {
  state.explanation = run->explanation();
  state.run = std::move(run);
  return state;
}

State taken_out(const State& state, std::size_t first, RunPtr run) {
  State next = with_run(state, std::move(run));
  erase_selection(next, first);
  const Hypotheses& hypotheses = next.run->hypotheses();
  const LargestByChance chance = state.seen.suspicions.chance;
  next.seen.suspicions = suspicions(next.run->scores(), hypotheses, rows_of(next.explanation.effects, hypotheses.size()));
  next.seen.suspicions.judge(chance);
  return next;
}

void note_given_up(State& next, std::size_t first, const SelectedEffect& effect) {
  const std::vector<EffectPtr>& suggested = next.explanation.suggested;
  const auto form = std::ranges::find(suggested, next.account.findings[first].hypothesis.effect, &EffectPtr::get);
  if (form != suggested.end()) next.excluded.forms.push_back(*form);
  next.excluded.given_up.push_back(effect.hypothesis);
  erase_selection(next, first);
  next.noise.is_behind = true;
}

State given_up(const State& state, std::size_t first, Context& context) {
  State next = with_run(state, context.runs.about(explanation_without(state, first), state.run));
  note_given_up(next, first, state.explanation.effects[first]);
  return next;
}

State with_fitted_noise(State state, Context& context) {
  const std::optional<FittedNoise> fitted =
      fitted_noise(state.run->mission().prepared(), state.noise.last, context.runs.progress());
  state.noise.is_behind = false;
  state.noise.explained = 0.0;
  state.account.noise = fitted;
  if (!fitted) return state;
  state.noise.last = fitted->fit;
  state.explanation.noise = fitted->fit.adjustment;
  const RunPtr run = context.runs.about(state.explanation, state.run);
  return with_run(std::move(state), run);
}

State without_insignificant(State state, Context& context) {
  for (std::size_t i = state.explanation.effects.size(); i-- > 0;) {
    const Finding& finding = state.account.findings[i];
    // Either sine or cosine of a line may be zero, depending on the phase.
    if (std::abs(state.explanation.effects[i].value) < kInsignificant * finding.sd && !is_of_a_line(finding))
      state = given_up(state, i, context);
  }
  return state;
}

}  // namespace coast::diagnose
