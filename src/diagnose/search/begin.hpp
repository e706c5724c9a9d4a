#pragma once
// Start of a search; private to the room.

#include "search/state.hpp"

namespace coast::diagnose {

/// The input of the diagnosis: without a gate, since rejected fixes cannot be explained, and with the stated noise.
[[nodiscard]] MissionInput with_open_gate(const MissionInput& input);

/// Two runs of the mission, the second from a loosened start; with fitted noise if the run estimates it.
[[nodiscard]] State begin(Context& context);

/// Effects of converters are detected in the samples without a filter. They are corrected if this raises the run's likelihood.
[[nodiscard]] State with_mended_samples(State state, Context& context);

/// With draws of the innovations: they are valid for all runs with the same covariances.
[[nodiscard]] State with_draws(State state, const Context& context);

[[nodiscard]] NoiseFinding described(const Mark& mark, double gain);

}  // namespace coast::diagnose
