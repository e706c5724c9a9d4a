#pragma once
// Observability of effects in a mission; private to the room.

#include "coast/diagnose/hypotheses.hpp"

namespace coast::diagnose {

inline constexpr double kEpisode = 10.0;  // s; closer onsets are hardly different hypotheses

/// Times the plausible size: plausible sizes are known to an order of magnitude or two.
inline constexpr double kImplausible = 30.0;

/// Whether the largest effect that is not implausible exceeds its standard deviation.
[[nodiscard]] inline bool is_observable(const Hypothesis& h, double information) {
  const double largest = kImplausible * h.plausible;
  return information * largest * largest >= 1.0;
}

}  // namespace coast::diagnose
