#include "search/selection.hpp"

#include "search/told.hpp"

namespace coast::diagnose {

std::vector<Proposal> selections(const Suspicion& s, const State& state, const Candidates& candidates, const Context& context) {
  constexpr int kHalvings = 4;
  const auto accept = [finding = finding_of(s, state.run->hypotheses()[s.hypothesis], state, candidates)](State& next,
                                                                                                          double gain) {
    next.account.findings.push_back(finding);
    next.account.findings.back().delta_log_likelihood = gain;
    next.excluded.rejected.clear();
  };
  std::vector<Proposal> proposals;
  double value = s.estimate;
  for (int i = 0; i <= kHalvings; ++i, value *= 0.5)
    proposals.push_back({.explanation = state.explanation.with({s.hypothesis, s.from, {}, value}),
                         .about = state.run,
                         .before = state.run->log_likelihood(),
                         .least_gain = 0.5 * threshold(state, context),
                         .sizes = Sizes::kMoveIfNeeded,
                         .accept = accept});
  return proposals;
}

}  // namespace coast::diagnose
