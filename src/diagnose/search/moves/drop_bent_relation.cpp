#include <algorithm>

#include "search/moves/moves.hpp"

namespace coast::diagnose {

Proposals drop_bent_relation(Look& look) {
  const State& state = look.state();
  if (!state.relation || look.run().log_likelihood() >= state.relation->without) return {};
  const auto is_it = [&](const Finding& f) { return f.hypothesis.effect == state.relation->effect.get(); };
  const auto found = std::ranges::find_if(state.account.findings, is_it);
  if (found == state.account.findings.end()) return {};  // it was replaced by an effect of the catalogue
  const auto index = static_cast<std::size_t>(found - state.account.findings.begin());
  const Explanation& explanation = look.run().explanation();
  return {.tries = {{.explanation = explanation.without(index),
                     .about = state.run,
                     .accept = [index, effect = explanation.effects[index]](State& next, double) {
                       note_given_up(next, index, effect);
                     }}}};
}

}  // namespace coast::diagnose
