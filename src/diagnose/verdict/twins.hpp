#pragma once
// A recording compared with twins of its mission; private to the room.

#include <string>
#include <vector>

#include "search/state.hpp"

namespace coast::diagnose {

/// The mission with the error model from the setup and the findings: from it twins are drawn.
[[nodiscard]] MissionInput modelled(const State& state);

/// Figures of the run compared with those of simulations, or without simulations with those of twins by the model of the state.
/// @param stage  for progress
[[nodiscard]] std::vector<TwinStatistic> compared(const char* stage, const State& state, const Context& context,
                                                  const std::vector<MissionInput>& simulations);

}  // namespace coast::diagnose
