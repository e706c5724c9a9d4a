#pragma once
// Every move of the search, one file each; private to the room.

#include <span>

#include "search/look.hpp"
#include "search/proposal.hpp"

namespace coast::diagnose {

/// Drops a relation that bends the trajectory further with each run until the mission is less likely than without it.
[[nodiscard]] Proposals drop_bent_relation(Look& look);
/// Changes sizes by the remaining effects in the run, halving the step as long as the result is less likely.
[[nodiscard]] Proposals move_sizes(Look& look);
/// For noise estimated by the run: as soon as effects explain much of what was attributed to noise.
[[nodiscard]] Proposals refit_estimated_noise(Look& look);
/// The time offset found from turns, if it is far from the configured one.
[[nodiscard]] Proposals move_time_offset(Look& look);
/// The likeliest random effect of an axis.
[[nodiscard]] Proposals add_random_effect(Look& look);
/// The stated noise, if innovations contradict it.
[[nodiscard]] Proposals fit_stated_noise(Look& look);
/// A line or a relation that is not in the catalogue.
[[nodiscard]] Proposals add_form(Look& look);
/// The likeliest mean effect of the catalogue.
[[nodiscard]] Proposals add_mean_effect(Look& look);
/// Sizes that have not converged yet, once nothing else explains more.
[[nodiscard]] Proposals settle_sizes(Look& look);
/// The stated noise once more, if nothing else is left.
[[nodiscard]] Proposals refit_noise(Look& look);

/// In the order of use. A new move is a file in search/moves and a line in moves.cpp.
[[nodiscard]] std::span<const Move> moves();

}  // namespace coast::diagnose
