#pragma once
// Observability of effects in a mission; private to the room.

#include "coast/diagnose/hypotheses.hpp"

namespace coast::diagnose {

inline constexpr double kEpisode = 10.0;  // s; closer onsets are hardly different hypotheses

/// Whether an effect of thirty times its plausible size exceeds its standard deviation: plausible sizes are known to an
/// order of magnitude or two.
[[nodiscard]] inline bool is_observable(const Hypothesis& h, double information) {
  constexpr double kFactor = 30.0;
  const double largest = kFactor * h.plausible;
  return information * largest * largest >= 1.0;
}

}  // namespace coast::diagnose
