#pragma once
// Observability of effects in a mission; private to the room.

#include <cmath>

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

/// Of an IMU of this grade; how far an antenna or a clock may be off depends on who has set it up.
[[nodiscard]] inline bool is_implausible(const Hypothesis& h, double value) {
  const bool is_of_imu = h.effect->site == Site::kGyro || h.effect->site == Site::kAccel;
  return is_of_imu && std::abs(value) > kImplausible * h.plausible;
}

}  // namespace coast::diagnose
