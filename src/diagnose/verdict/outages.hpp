#pragma once
// Influence of effects on the drift in artificial outages; private to the room.

#include <optional>

#include "search/state.hpp"

namespace coast::diagnose {

/// If artificial outages drift farther with all selected effects than with none, the effect without which they drift least: it
/// explains fixes by errors that the sensors did not have.
[[nodiscard]] std::optional<std::size_t> what_spoils_outages(const State& state, const Context& context);

}  // namespace coast::diagnose
