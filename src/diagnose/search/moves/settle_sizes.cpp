#include "search/moves/moves.hpp"

namespace coast::diagnose {

Proposals settle_sizes(Look& look) {
  constexpr double kSettled = 0.1;  // sd that a size may still change
  if (!look.candidates().empty() || look.step().farthest() < kSettled) return {};
  return {.tries = {{.explanation = look.state().explanation, .about = look.state().run}}};
}

}  // namespace coast::diagnose
