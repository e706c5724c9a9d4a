#pragma once
// Repeated test of every selected effect together with all others; private to the room.

#include "search/state.hpp"

namespace coast::diagnose {

struct Reviewed {
  State state;
  bool changed = false;  ///< an effect was replaced by another one, or removed
};
/// Whether it is needed, and the right one. A line is not reviewed: no effect of the catalogue looks like one.
[[nodiscard]] Reviewed reviewed(State state, Context& context);

}  // namespace coast::diagnose
