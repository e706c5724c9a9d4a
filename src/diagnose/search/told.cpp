#include "search/told.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "evidence/observable.hpp"

namespace coast::diagnose {

namespace {

Alternative alternative(const Suspicion& s, double log_odds, const Hypotheses& hypotheses) {
  const Hypothesis& h = hypotheses[s.hypothesis];
  return {std::string(h.effect->name), std::string(name(h.effect->site)), h.axis_name(), log_odds,
          is_implausible(h, s.estimate)};
}

Alternative alternative(const FittedEffect& fit, double log_odds) {
  return {std::string(fit.noise.effect->name), std::string(name(fit.noise.effect->site)), axis_letter(fit.noise.axis),
          log_odds};
}

/// Other mean effects that the data cannot exclude as alternatives.
void add_mean_effects(const Suspicion& s, const State& state, const Candidates& candidates, std::vector<Alternative>& to) {
  const auto tell = [&](const Suspicion& other) {
    if (other.hypothesis == s.hypothesis) return;
    if (std::ranges::find(state.excluded.exchanged, other.hypothesis) != state.excluded.exchanged.end()) return;
    const std::optional<double> mine = candidates.gained_by_runs(s.hypothesis);
    const std::optional<double> its = candidates.gained_by_runs(other.hypothesis);
    const double by_data = mine && its ? *mine - *its : 0.5 * (s.likelihood_ratio - other.likelihood_ratio);
    if (const auto odds = log_odds_told(by_data, by_data + other.price() - s.price()))
      to.push_back(alternative(other, *odds, state.run->hypotheses()));
  };
  std::ranges::for_each(state.seen.suspicions.all, tell);
  std::ranges::for_each(state.seen.suspicions.implausible, tell);
}

}  // namespace

std::optional<double> log_odds_told(double by_data, double by_evidence) {
  const double odds = std::max(by_data, by_evidence);
  return odds < kLogOdds ? std::optional(odds) : std::nullopt;
}

Finding finding_of(const Suspicion& s, const Hypothesis& h, const State& state, const Candidates& candidates) {
  Finding finding{.hypothesis = h,
                  .from = s.from,
                  .to = {},
                  .from_sd_s = s.from_sd_s,
                  .value = s.estimate,
                  .sd = s.sd,
                  .p_value = s.p_value,
                  .price = s.price(),
                  .held_out_gain = {},
                  .alternatives = {},
                  .stability = {}};
  add_mean_effects(s, state, candidates, finding.alternatives);
  for (const FittedEffect& fit : state.seen.beaten)
    if (const auto odds = log_odds_told(0.5 * s.likelihood_ratio - fit.gain, evidence_of(s, state) - evidence_of(fit)))
      finding.alternatives.push_back(alternative(fit, *odds));
  std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
  return finding;
}

NoiseFinding noise_finding_of(const std::vector<FittedEffect>& fits, double p_value, const State& state) {
  const FittedEffect& f = fits.front();
  const NoiseEffect& effect = *f.noise.effect;
  NoiseFinding finding{.name = std::string(effect.name),
                       .sensor = std::string(name(effect.site)),
                       .axis = axis_letter(f.noise.axis),
                       .parameter = std::string(effect.parameter),
                       .unit = std::string(effect.unit),
                       .value = f.noise.root,
                       .sd = f.noise.root * f.log_sd,
                       .delta_log_likelihood = f.gain,
                       .p_value = p_value,
                       .place = effect.level ? NoiseFinding::Place::kEffects : NoiseFinding::Place::kErrorModel,
                       .time_s = f.noise.time,
                       .time_sd_s = f.noise.time * f.log_time_sd,
                       .meaning = std::string(effect.meaning),
                       .equation = std::string(effect.equation),
                       .separating_manoeuvre = std::string(effect.separating_manoeuvre)};
  for (std::size_t i = 1; i < fits.size(); ++i)
    if (const auto odds = log_odds_told(f.gain - fits[i].gain, evidence_of(f) - evidence_of(fits[i])))
      finding.alternatives.push_back(alternative(fits[i], *odds));
  // Noise must not hide what a recorded signal explains, however large that would be.
  for (const std::vector<Suspicion>* some : {&state.seen.suspicions.all, &state.seen.suspicions.implausible})
    for (const Suspicion& s : *some)
      if (const auto odds = log_odds_told(f.gain - 0.5 * s.likelihood_ratio, evidence_of(f) - evidence_of(s, state)))
        finding.alternatives.push_back(alternative(s, *odds, state.run->hypotheses()));
  std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
  return finding;
}

}  // namespace coast::diagnose
