#include "verdict/diagnosis_of.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "verdict/alternatives.hpp"
#include "verdict/detectable.hpp"
#include "verdict/names.hpp"
#include "verdict/twins.hpp"

namespace coast::diagnose {

namespace {

/// The account in the terms of the report. Values are those of the run.
Account worded(const State& state) {
  Account account = state.account;
  for (std::size_t i = 0; i < account.findings.size(); ++i) account.findings[i].value = state.explanation.effects[i].value;
  name_relations(state, account.findings);
  fold_residues(account);
  return account;
}

std::vector<NoiseFinding> all_noise(Account account, const State& state, const Context& context) {
  std::vector<NoiseFinding> noise = std::move(account.converters);
  std::ranges::move(stated_noise_findings(state, context), std::back_inserter(noise));
  std::ranges::move(account.random, std::back_inserter(noise));
  std::ranges::transform(state.start.beyond, std::back_inserter(noise), described_bias);
  return noise;
}

/// Fit of the run, including the gain of biases at the start with their reported sigmas.
Fit fit_after(const State& state) {
  Fit fit = state.run->mission().fit();
  double of_biases = state.start.standstill;
  for (const TurnOn& one : state.start.beyond) of_biases += one.gain();
  fit.log_likelihood_per_epoch += of_biases / static_cast<double>(state.run->mission().solution().forward.innovations.size());
  return fit;
}

/// A relation reported by the name of an effect was found by it: that effect is not reported elsewhere.
void forget_found(Diagnosis& diagnosis) {
  const auto is_found = [&](const auto& one) {
    return std::ranges::any_of(diagnosis.findings, [&](const Finding& f) {
      return f.hypothesis.effect == one.hypothesis.effect && f.hypothesis.axis == one.hypothesis.axis;
    });
  };
  std::erase_if(diagnosis.detectable_not_found, is_found);
  std::erase_if(diagnosis.not_observable, is_found);
}

}  // namespace

Diagnosis diagnosis_of(const State& state, const Context& context, const Baseline& before) {
  Diagnosis result;
  result.grade = context.runs.grade();
  result.threshold = threshold(state, context);
  tell_what_was_not_found(state, result.threshold, result);
  Account account = worded(state);
  result.findings = std::move(account.findings);
  result.noise = all_noise(std::move(account), state, context);
  join_entries_with_exits(result.findings);
  join_quadratures(result.findings, result.suggested);
  forget_found(result);
  std::ranges::stable_sort(result.findings, std::ranges::greater{}, &Finding::delta_log_likelihood);
  join_times(result.findings);
  const std::vector<EffectPtr>& suggested = state.explanation.suggested;
  result.suggested.insert(result.suggested.end(), suggested.begin(), suggested.end());
  result.before = before.fit;
  result.innovations_before = before.innovations;
  result.after = fit_after(state);
  result.innovations_after = state.run->mission().solution().forward.innovations;
  result.outage_change = outage_difference(result.before, result.after);
  result.modelled = modelled(state);
  return result;
}

}  // namespace coast::diagnose
