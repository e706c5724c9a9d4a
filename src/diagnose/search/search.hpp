#pragma once
// The search for errors of a mission that are not in its model; private to the room.

#include "search/state.hpp"

namespace coast::diagnose {

struct Step {
  State state;
  bool goes_on = false;  ///< a change was made that may reveal more
};
/// One examination of the accepted run, and the first accepted move.
[[nodiscard]] Step step(const State& standing, Context& context);

/// Repeats steps until no move is accepted, and reviews every selected effect.
[[nodiscard]] State searched(State state, Context& context);

}  // namespace coast::diagnose
