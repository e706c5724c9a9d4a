#pragma once
// What the estimables of the processes have in common. Private to the room.

#include <cmath>

#include "coast/noise/estimable.hpp"

namespace coast::noise {

/// Processes whose block has one factor, exp(u[0]), on all its variances: the derivative is the block's own variances.
[[nodiscard]] inline SampleBlock variances_of(SampleBlock block) {
  block.Phi.setZero();
  return block;
}

/// Range of log(variance): from where nothing of it can be seen to all of the signal and more.
[[nodiscard]] inline Interval log_variance_range(double variance) {
  return {std::log(variance) - 25.0, std::log(variance) + 7.0};
}

}  // namespace coast::noise
