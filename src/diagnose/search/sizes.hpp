#pragma once
// Updates of the sizes of selected effects from the results of runs; private to the room.

#include <vector>

#include "search/movement.hpp"
#include "search/proposal.hpp"

namespace coast::diagnose {

inline constexpr double kNear = 1.0;  // sd; if no size changes more, the remainder may be another effect

/// A Gauss-Newton step may be too long, or wrong if the mission is not linear: it is halved as long as it is less likely. None
/// if no step from the accepted run is likelier, as found before.
[[nodiscard]] std::vector<Proposal> moved_sizes(const State& state, const Movement& step);
/// None of them is likelier: sizes are kept.
void keep_sizes(State& state);
/// Changes the sizes of the accepted run until they converge.
[[nodiscard]] State with_settled_sizes(State state, Context& context);

}  // namespace coast::diagnose
