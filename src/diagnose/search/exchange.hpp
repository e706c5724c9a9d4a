#pragma once
// Exchanges that no single move achieves; private to the room.

#include <optional>

#include "search/state.hpp"

namespace coast::diagnose {

/// Whether an effect that begins at some time has a counterpart that acts from the start on.
[[nodiscard]] bool may_have_lasted(const State& state, std::size_t index);

/// An effect present from the start on is explained by one that begins later if the first fixes in motion contradict it for
/// another reason; that reason has to be found too. Replaces the effect by the lasting one (all of it, if a part was
/// selected), likelier or not, with room for one more effect, and excludes the replaced one.
/// @return  none if the recording cannot show it, or the filter fails with it
[[nodiscard]] std::optional<State> with_lasting_effect(const State& state, std::size_t index, Context& context);

/// The first run estimates a constant as a bias, about which all others are linearised: no score shows an effect constant
/// during this mission. Replaces all of the bias by the most plausible such effect, likelier or not, with room for one more
/// effect.
/// @param index  of the bias beyond the error model  @return  none if there is none, or the filter fails
[[nodiscard]] std::optional<State> with_constant_effect(const State& state, std::size_t index, Context& context);

}  // namespace coast::diagnose
