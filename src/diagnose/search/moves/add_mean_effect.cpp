#include "search/moves/moves.hpp"
#include "search/selection.hpp"

namespace coast::diagnose {

Proposals add_mean_effect(Look& look) {
  Candidates& candidates = look.candidates();
  if (candidates.empty()) return {};
  const Suspicion s = candidates.likeliest();
  Proposals proposals{.tries = selections(s, look.state(), candidates, look.context()),
                      .reject = [s](State& next) { next.excluded.rejected.push_back(s.hypothesis); },
                      .looks_again = true};
  for (Proposal& one : proposals.tries)
    one.accept = [select = one.accept](State& next, double gain) {
      select(next, gain);
      next.noise.is_behind = true;
      next.noise.explained += gain;
    };
  return proposals;
}

}  // namespace coast::diagnose
