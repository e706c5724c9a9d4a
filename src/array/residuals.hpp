#pragma once
// Differences of the sensors of one channel at an instant. Private to the room.

#include <span>

#include "coast/array/signals.hpp"

namespace coast::array {

/// Mean over the sensors that may be used; over all if none may.
[[nodiscard]] double plain_mean(const Signals& signals, int channel, std::size_t n);

/// Solves for `own_variances` in place, for at least two.
void solve_own_variances(std::span<double> variances);

struct SpreadOfChange {
  double variance = 0.0;  ///< of z_k[n] - z_k[n-1] about its mean over the sensors, unbiased
  int sensors = 0;
};
/// Over the sensors that may be used at n and n - 1.
[[nodiscard]] SpreadOfChange spread_of_change(const Signals& signals, int channel, std::size_t n);

}  // namespace coast::array
