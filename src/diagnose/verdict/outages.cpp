#include "verdict/outages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "coast/parallel.hpp"
#include "coast/record/error.hpp"

namespace coast::diagnose {

PairedDifference outage_difference(const Fit& before, const Fit& after) {
  PairedDifference d;
  const std::size_t count = before.outages_m.size();
  if (count != after.outages_m.size() || count < 2) return d;
  d.count = static_cast<int>(count);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double farther = after.outages_m[i] - before.outages_m[i];
    sum += farther;
    squares += farther * farther;
  }
  const double n = d.count;
  d.mean = sum / n;
  d.sd = std::sqrt(std::max(0.0, squares - n * d.mean * d.mean) / (n * (n - 1.0)));
  return d;
}

bool drifts_farther(const Fit& before, const Fit& after) {
  constexpr double kFarther = 1.5;
  constexpr double kByChance = 2.33;  // sd: 1 %
  const PairedDifference d = outage_difference(before, after);
  return after.outage_rms_m > kFarther * before.outage_rms_m && d.mean > kByChance * d.sd;
}

namespace {

/// Fit of a run with other sizes; the drift is infinite if the filter diverges.
Fit fit_with(const std::vector<SelectedEffect>& effects, const State& state, const Context& context) {
  const Runs& runs = context.runs;
  try {
    return MissionRun(runs.with_sizes(effects, *state.run), runs.grade(), state.explanation.suggested, runs.progress()).fit();
  } catch (const NumericalError&) {
    return {.outage_rms_m = std::numeric_limits<double>::infinity()};
  }
}

}  // namespace

std::optional<std::size_t> what_spoils_outages(const State& state, const Context& context) {
  const std::vector<SelectedEffect>& effects = state.explanation.effects;
  if (effects.empty()) return std::nullopt;
  if (!drifts_farther(fit_with({}, state, context), state.run->mission().fit())) return std::nullopt;
  struct Without {
    std::size_t first, count;
    double rms = 0.0;
  };
  std::vector<Without> all;
  for_each_selection(state.account, [&](std::size_t first, std::size_t count) { all.push_back({first, count}); });
  coast::parallel_for_each(all, [&](Without& one) {
    one.rms = fit_with(state.explanation.without(one.first, one.count).effects, state, context).outage_rms_m;
  });
  return std::ranges::min_element(all, {}, &Without::rms)->first;
}

}  // namespace coast::diagnose
