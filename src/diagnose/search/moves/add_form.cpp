#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "search/moves/moves.hpp"
#include "search/told.hpp"

namespace coast::diagnose {

namespace {

EffectPtr shifted(const Effect& line, double by_hertz) {
  return harmonic_disturbance(line.site, line.axes.front().front() - 'x', line.fixed[0].value + by_hertz, line.fixed[1].value);
}

/// Likelihood ratio of sine and cosine of each line. @param first  of their columns
std::vector<double> likelihood_ratios(const Examination& e, Eigen::Index first, std::size_t lines) {
  std::vector<double> ratios;
  for (Eigen::Index at = first; ratios.size() < lines; at += 2) {
    const Eigen::Vector2d score = e.score.segment<2>(at);
    ratios.push_back(score.dot(Eigen::Matrix2d(e.information.block<2, 2>(at, at)).ldlt().solve(score)));
  }
  return ratios;
}

/// The likeliest frequency near that of a line, which the periodogram gives to a fraction of its width.
EffectPtr refined(const Effect& line, const State& state, Runs& runs) {
  constexpr int kSide = 6;
  constexpr double kStep = 0.1;  // of a line's width
  const std::vector<record::ImuSample>& samples = state.run->mission().mission().imu.samples;
  const double step = kStep / (samples.back().t - samples.front().t);
  Explanation with_neighbours = state.explanation;
  for (int i = -kSide; i <= kSide; ++i) with_neighbours.suggested.push_back(shifted(line, i * step));
  const RunPtr run = runs.about(with_neighbours, state.run);
  const std::size_t lines = with_neighbours.suggested.size() - state.explanation.suggested.size();
  const std::vector<double> ratio = likelihood_ratios(run->scores(), state.run->hypotheses().size(), lines);
  const auto best = static_cast<std::size_t>(std::ranges::max_element(ratio) - ratio.begin());
  double shift = static_cast<double>(best) - kSide;
  if (best > 0 && best + 1 < ratio.size())  // the vertex of the parabola through the largest and its neighbours
    shift += 0.5 * (ratio[best + 1] - ratio[best - 1]) / (2.0 * ratio[best] - ratio[best - 1] - ratio[best + 1]);
  return shifted(line, shift * step);
}

/// Findings for each coefficient of a form.
std::vector<Finding> findings_of(const Form& form, const Effect& effect, const State& state, const Candidates& candidates,
                                 Grade grade) {
  std::vector<Finding> findings;
  for (Eigen::Index axis = 0; axis < static_cast<Eigen::Index>(effect.axes.size()); ++axis) {
    const Suspicion s{.hypothesis = state.run->hypotheses().size() + axis,
                      .from = {},
                      .likelihood_ratio = form.likelihood_ratio,
                      .log_bayes = 0.5 * form.likelihood_ratio - form.log_places,
                      .p_value = form.p_value};
    findings.push_back(finding_of(s, {&effect, axis, effect.plausible[static_cast<std::size_t>(grade)]}, state, candidates));
  }
  return findings;
}

/// Report on an accepted form.
struct Selected {
  EffectPtr effect;
  std::vector<Finding> findings;
  double stability = 0.0;
  double before = 0.0;  ///< log-likelihood
  void tell(State& next, double gain) const {
    const std::size_t first = next.account.findings.size();
    next.account.findings.insert(next.account.findings.end(), findings.begin(), findings.end());
    next.account.findings[first].delta_log_likelihood = gain;
    next.excluded.rejected.clear();
    next.noise.is_behind = true;
    if (effect->relation.empty()) return;
    next.account.findings[first].stability = stability;
    next.relation = {effect, before};
  }
};

}  // namespace

// The coefficients are estimated jointly with the selected ones. Rejected if the form does not explain more than the
// likeliest effect of the catalogue.
Proposals add_form(Look& look) {
  const std::optional<Form>& form = look.form();
  if (!form || !look.candidates().gain_is_exceeded_by(look.form_gain())) return {};
  const State& state = look.state();
  Runs& runs = look.context().runs;
  const EffectPtr effect = form->effect->relation.empty() ? refined(*form->effect, state, runs) : form->effect;
  const Selected selected{effect, findings_of(*form, *effect, state, look.candidates(), runs.grade()), form->stability,
                          state.run->log_likelihood()};
  Explanation explanation = state.explanation;
  explanation.suggested.push_back(effect);
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(effect->axes.size()); ++i)
    explanation.effects.push_back({.hypothesis = state.run->hypotheses().size() + i});
  return {.tries = {{.explanation = std::move(explanation),
                     .about = state.run,
                     .before = selected.before,
                     .least_gain = form->log_places + std::max(look.candidates().gain(), -std::log(kFormFalseAlarm)),
                     .sizes = Sizes::kMove,
                     .accept = [selected](State& next, double gain) { selected.tell(next, gain); }}},
          .reject = [effect](State& next) { next.excluded.forms.push_back(effect); },
          .looks_again = true};
}

}  // namespace coast::diagnose
