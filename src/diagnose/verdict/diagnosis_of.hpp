#pragma once
// Findings of a search, in the order and the terms of the report; private to the room.

#include <vector>

#include "search/state.hpp"

namespace coast::diagnose {

/// The mission before any finding.
struct Baseline {
  Fit fit;
  std::vector<estimate::InnovationRecord> innovations;
};

[[nodiscard]] Diagnosis diagnosis_of(const State& state, const Context& context, const Baseline& before);

}  // namespace coast::diagnose
