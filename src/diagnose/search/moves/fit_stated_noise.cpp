#include "search/moves/moves.hpp"

namespace coast::diagnose {

Proposals fit_stated_noise(Look& look) {
  if (look.takes_means_first()) return {};
  const std::optional<FittedNoise>& fitted = look.stated_noise();
  if (!fitted || fitted->gain() <= look.form_gain() || !look.candidates().gain_is_exceeded_by(fitted->gain())) return {};
  Explanation explanation = look.state().explanation;
  explanation.noise = fitted->fit.adjustment;
  return {.tries = {{.explanation = std::move(explanation),
                     .about = look.state().run,
                     .accept = [fitted](State& next, double) { next.account.noise = fitted; }}},
          .is_noise = true};
}

}  // namespace coast::diagnose
