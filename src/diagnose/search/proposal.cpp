#include "search/proposal.hpp"

#include "search/movement.hpp"

namespace coast::diagnose {

std::optional<State> accepted(const Proposal& proposal, const State& from, Context& context) {
  const auto gain = [&](const RunPtr& run) { return run->log_likelihood() - proposal.before; };
  RunPtr run = context.runs.try_about(proposal.explanation, proposal.about);
  const bool moves = proposal.sizes == Sizes::kMove || proposal.sizes == Sizes::kMoveIfNeeded;
  if (run && moves && (proposal.sizes == Sizes::kMove || gain(run) < proposal.least_gain))
    run = context.runs.try_about(followed(*run), run);
  if (!run || gain(run) < proposal.least_gain) return std::nullopt;
  State next = with_run(from, run);
  proposal.accept(next, gain(run));
  if (next.run->log_likelihood() < proposal.least_log_likelihood) return std::nullopt;
  return next;
}

std::optional<State> first_accepted(const std::vector<Proposal>& proposals, const State& from, Context& context) {
  for (const Proposal& proposal : proposals)
    if (std::optional<State> next = accepted(proposal, from, context)) return next;
  return std::nullopt;
}

}  // namespace coast::diagnose
