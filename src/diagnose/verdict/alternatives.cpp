#include "verdict/alternatives.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace coast::diagnose {

namespace {

Alternative named(const NoiseFinding& f) {
  return {f.name, f.sensor, f.axis, 0.0};
}

Alternative named(const Hypothesis& h) {
  return {std::string(h.effect->name), std::string(name(h.effect->site)), h.axis_name(), 0.0};
}

/// All findings, by name.
std::vector<Alternative> found(const State& state, const Context& context) {
  std::vector<Alternative> all;
  for (const Finding& f : state.account.findings) all.push_back(named(f.hypothesis));
  for (const NoiseFinding& f : stated_noise_findings(state, context)) all.push_back(named(f));
  for (const NoiseFinding& f : state.account.random) all.push_back(named(f));
  for (const TurnOn& one : state.start.beyond) all.push_back(named(described_bias(one)));
  return all;
}

bool has(const std::vector<Alternative>& all, const Alternative& a) {
  return std::ranges::any_of(
      all, [&](const Alternative& b) { return a.name == b.name && a.sensor == b.sensor && a.axis == b.axis; });
}

}  // namespace

std::vector<NoiseFinding> stated_noise_findings(const State& state, const Context& context) {
  std::vector<NoiseFinding> findings;
  if (!state.account.noise) return findings;
  const std::optional<estimate::NoiseFitChoice>& asked_for = context.asked_for;
  for (const NoiseFinding& f : state.account.noise->findings)
    if (!asked_for || (f.sensor == "gnss" ? !asked_for->gnss_scale : !asked_for->imu_white_noise)) findings.push_back(f);
  return findings;
}

void tell_of(const State& other, double log_odds, const Context& context, State& state) {
  if (log_odds > kLogOdds) return;
  const std::vector<Alternative> ours = found(state, context);
  const std::vector<Alternative> theirs = found(other, context);
  const auto add = [&](const Alternative& explained, std::vector<Alternative>& alternatives) {
    if (has(theirs, explained)) return;
    for (const Alternative& one : theirs) {
      if (has(ours, one)) continue;
      std::erase_if(alternatives, [&](const Alternative& told) { return has({one}, told); });
      alternatives.push_back({one.name, one.sensor, one.axis, log_odds, one.implausible});
    }
    std::ranges::sort(alternatives, {}, &Alternative::log_odds);
  };
  for (Finding& f : state.account.findings) add(named(f.hypothesis), f.alternatives);
  for (NoiseFinding& f : state.account.random) add(named(f), f.alternatives);
  for (TurnOn& one : state.start.beyond) add(named(described_bias(one)), one.alternatives);
}

void look_at_start(State& state) {
  const std::vector<TurnOn> told = std::exchange(state.start.beyond, beyond_stated(state.run->mission()));
  for (TurnOn& one : state.start.beyond)
    for (const TurnOn& before : told)
      if (before.sensor == one.sensor && before.axis == one.axis) one.alternatives = before.alternatives;
}

}  // namespace coast::diagnose
