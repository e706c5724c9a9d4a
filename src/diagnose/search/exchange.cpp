#include "search/exchange.hpp"

#include <algorithm>
#include <utility>

#include "search/proposal.hpp"
#include "search/told.hpp"

namespace coast::diagnose {

namespace {

/// Reset by an exchange: temporary rejections, one more effect, and the noise.
void make_room(State& state) {
  state.excluded.rejected.clear();
  ++state.limits.most_effects;
  state.noise.is_behind = true;
}

/// An effect in addition to those of the state, likelier or not.
Proposal forced(const Suspicion& s, const State& state) {
  const auto accept = [finding = finding_of(s, state.run->hypotheses()[s.hypothesis], state, {})](State& next, double gain) {
    next.account.findings.push_back(finding);
    next.account.findings.back().delta_log_likelihood = gain;
  };
  return {.explanation = state.explanation.with({s.hypothesis, s.from, {}, s.estimate}),
          .about = state.run,
          .before = state.run->log_likelihood(),
          .accept = accept};
}

/// From now on the bias has the error model's prior: another effect explains the rest of the constant.
State with_shared(const TurnOn& bias, State state, Context& context) {
  const double before = state.run->mission().log_likelihood();
  Explanation explanation = state.explanation;
  explanation.shared.push_back(bias);
  // A step soon after the start is equivalent.
  state.excluded.exchanged.push_back(state.run->hypotheses().bias_step(sensor_site(bias.sensor), bias.axis));
  state.relation.reset();
  const RunPtr run = context.runs.about(explanation, state.run);
  state.start.standstill += before - run->mission().log_likelihood();
  return with_run(std::move(state), run);
}

}  // namespace

bool may_have_lasted(const State& state, std::size_t index) {
  return !state.run->hypotheses()[state.explanation.effects[index].hypothesis].effect->lasting.empty();
}

std::optional<State> with_lasting_effect(const State& state, std::size_t index, Context& context) {
  const SelectedEffect one = state.explanation.effects[index];
  const Hypothesis begins = state.run->hypotheses()[one.hypothesis];
  State base = taken_out(state, index, context.runs.about(explanation_without(state, index), state.run));
  make_room(base);
  base.excluded.exchanged.push_back(one.hypothesis);
  const auto is_lasting = [&](Eigen::Index hypothesis) {
    const Hypothesis& h = base.run->hypotheses()[hypothesis];
    return h.effect->name == begins.effect->lasting && h.axis_name() == begins.axis_name();
  };
  Explanation explanation = base.explanation;
  if (const auto share = std::ranges::find_if(explanation.effects, is_lasting, &SelectedEffect::hypothesis);
      share != explanation.effects.end()) {
    share->value += one.value;
    return accepted({.explanation = std::move(explanation), .about = base.run}, base, context);
  }
  const std::vector<Suspicion>& all = base.seen.suspicions.all;
  const auto lasting = std::ranges::find_if(all, is_lasting, &Suspicion::hypothesis);
  if (lasting == all.end() || base.excluded.excludes(lasting->hypothesis)) return std::nullopt;
  Suspicion from_the_start = *lasting;
  from_the_start.estimate = one.value;
  return accepted(forced(from_the_start, base), base, context);
}

std::optional<State> with_constant_effect(const State& state, std::size_t index, Context& context) {
  const TurnOn bias = state.start.beyond[index];
  const std::optional<Suspicion> constant = constant_like(bias, state.run->mission());
  State base = state;
  make_room(base);
  const auto is_selected = [&](const SelectedEffect& one) { return one.hypothesis == constant->hypothesis; };
  if (!constant || base.explanation.is_shared(bias) || base.excluded.excludes(constant->hypothesis) ||
      std::ranges::any_of(base.explanation.effects, is_selected))
    return std::nullopt;
  base = with_shared(bias, std::move(base), context);
  std::optional<State> next = accepted(forced(*constant, base), base, context);
  if (!next) return std::nullopt;
  // Sensor errors are estimated again about the remainder of the bias.
  const RunPtr run = context.runs.about(next->explanation, next->run);
  return with_run(*std::move(next), run);
}

}  // namespace coast::diagnose
