#pragma once
// Proposal of an effect of the catalogue; private to the room.

#include <vector>

#include "search/candidates.hpp"
#include "search/proposal.hpp"

namespace coast::diagnose {

/// The effect in addition to the selected ones, with the size from its score, and again with all sizes changed. If the mission
/// is not linear in it the first estimate is too large: it is halved until the likelihood rises. Accepted if not explained
/// by chance.
/// @param candidates  among which it was chosen
[[nodiscard]] std::vector<Proposal> selections(const Suspicion& s, const State& state, const Candidates& candidates,
                                               const Context& context);

}  // namespace coast::diagnose
