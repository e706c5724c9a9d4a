#include "search/moves/moves.hpp"

namespace coast::diagnose {

namespace {

constexpr double kMuch = 100.0;  // log-likelihood of effects above which noise fitted without them included them

/// Effects selected since the last fit may have been attributed to noise. Costs a hundred runs.
Proposals refit(Look& look) {
  const State& state = look.state();
  if (!state.noise.is_behind) return {};
  if (!state.account.noise) {
    const auto open = [](State& next) { next.noise.is_behind = next.noise.tried = false; };
    return {.reject = open, .looks_again = state.noise.tried};
  }
  Explanation explanation = state.explanation;
  explanation.noise.reset();
  const RunPtr stated = look.context().runs.about(explanation, state.run);
  const std::optional<FittedNoise> fitted =
      fitted_noise(stated->mission().prepared(), state.noise.last, look.context().runs.progress());
  if (fitted) explanation.noise = fitted->fit.adjustment;
  const auto note = [fitted](State& next) { next.noise = {.last = fitted ? std::optional(fitted->fit) : next.noise.last}; };
  return {.tries = {{.explanation = explanation,
                     .about = fitted ? stated : state.run,
                     .before = state.run->log_likelihood(),
                     .least_gain = 0.0,  // the fit is on a part of a long mission only
                     .accept =
                         [fitted, note](State& next, double) {
                           next.account.noise = fitted;
                           note(next);
                         }}},
          .reject = note};
}

}  // namespace

Proposals refit_estimated_noise(Look& look) {
  return look.context().asked_for && look.state().noise.explained > kMuch ? refit(look) : Proposals{};
}

Proposals refit_noise(Look& look) {
  return refit(look);
}

}  // namespace coast::diagnose
