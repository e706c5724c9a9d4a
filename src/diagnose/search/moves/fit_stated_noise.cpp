#include "search/moves/moves.hpp"

namespace coast::diagnose {

Proposals fit_stated_noise(Look& look) {
  const std::optional<FittedNoise>& fitted = look.stated_noise();
  if (!fitted || fitted->gain() <= look.form_gain() || !look.candidates().gain_is_exceeded_by(fitted->gain())) return {};
  Explanation explanation = look.state().explanation;
  explanation.noise = fitted->fit.adjustment;
  return {.tries = {{.explanation = std::move(explanation), .about = look.state().run, .accept = [fitted](State& next, double) {
                       next.account.noise = fitted;
                     }}}};
}

Proposals fit_stated_noise_last(Look& look) {
  return look.candidates().empty() ? fit_stated_noise(look) : Proposals{};
}

}  // namespace coast::diagnose
