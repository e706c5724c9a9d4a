#include <algorithm>
#include <cmath>

#include "search/moves/moves.hpp"
#include "search/selection.hpp"
#include "search/sizes.hpp"

namespace coast::diagnose {

namespace {

/// Noise fitted at the configured offset explains the misfit, and would continue to explain it.
State without_fitted_noise(const State& state, Context& context) {
  if (!state.explanation.noise) return state;
  Explanation explanation = state.explanation;
  explanation.noise.reset();
  State next = with_run(state, context.runs.about(explanation, state.run));
  next.account.noise.reset();
  return next;
}

/// Sizes and noise about the new offset. @param was_fitted  the noise, before
State settled(State state, bool was_fitted, Context& context) {
  state = with_settled_sizes(std::move(state), context);
  state.noise.last.reset();
  state.noise.is_behind = true;
  if (!was_fitted) return state;
  return with_fitted_noise(std::move(state), context);
}

}  // namespace

Proposals move_time_offset(Look& look) {
  constexpr double kFar = 0.1;  // s: turns tell it to half of this
  constexpr double kSds = 2.0;  // of its prior: nearer ones a run that estimates it finds itself
  const std::optional<double> guess = look.state().limits.time_offset_s;
  if (!guess) return {};
  const auto is_tried = [](State& next) { next.limits.time_offset_s.reset(); };
  const study::Setup& stated = look.context().runs.recorded().setup;
  const double shift = *guess - stated.time_offset_s;
  if (std::abs(shift) < std::max(kFar, kSds * stated.filter.auxiliary.time_offset_sd_s)) return {.reject = is_tried};
  static_cast<void>(look.examination());
  Context& context = look.context();
  const bool was_fitted = look.state().explanation.noise.has_value();
  const State base = without_fitted_noise(look.state(), context);
  const std::vector<Hypothesis>& all = base.run->hypotheses().all();
  const auto offset = std::ranges::find_if(all, [](const Hypothesis& h) { return h.effect->name == "gnss_time_offset"; });
  Proposals proposals{
      .tries = selections({.hypothesis = offset - all.begin(), .from = {}, .estimate = shift}, base, {}, context),
      .reject = [is_tried, h = offset - all.begin()](State& next) {
        is_tried(next);
        next.excluded.rejected.push_back(h);
      }};
  const double standing = look.state().run->log_likelihood();
  for (Proposal& one : proposals.tries) {
    one.least_log_likelihood = standing;  // with stated noise that is far too small a wrong offset may seem to gain
    one.accept = [select = one.accept, was_fitted, is_tried, &context](State& next, double gain) {
      is_tried(next);
      select(next, gain);
      Finding& finding = next.account.findings.back();
      finding.p_value = next.seen.suspicions.chance.p_value(2.0 * gain);
      finding.alternatives.clear();  // they resembled it at the configured offset
      next.account.noise.reset();
      next = settled(std::move(next), was_fitted, context);
    };
  }
  return proposals;
}

}  // namespace coast::diagnose
