#include "search/moves/moves.hpp"
#include "search/sizes.hpp"

namespace coast::diagnose {

Proposals move_sizes(Look& look) {
  if (!(look.step().farthest() > kNear)) return {};
  return {.tries = moved_sizes(look.state(), look.step()), .reject = keep_sizes};
}

}  // namespace coast::diagnose
