#pragma once
// Detectable size of an effect that was not found, or why there is none; private to the room.

#include "search/state.hpp"

namespace coast::diagnose {

/// Sets `detectable_not_found` and `not_observable` from the accepted run, with all findings.
/// @param threshold  of the likelihood ratio
void tell_what_was_not_found(const State& state, double threshold, Diagnosis& diagnosis);

}  // namespace coast::diagnose
