#pragma once
// Effects of another explanation of the mission that replace an effect; private to the room.

#include "search/state.hpp"

namespace coast::diagnose {

/// For the stated noise, without the parts that the configuration estimates anyway.
[[nodiscard]] std::vector<NoiseFinding> stated_noise_findings(const State& state, const Context& context);

/// Reports different effects of another explanation as alternatives.
/// @param log_odds  of this one relative to the other
void tell_of(const State& other, double log_odds, const Context& context, State& state);

/// Biases at the start beyond the error model, after all else is found.
void look_at_start(State& state);

}  // namespace coast::diagnose
