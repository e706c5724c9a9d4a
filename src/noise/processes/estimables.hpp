#pragma once
// Common functions of the estimables of the processes. Private to the room.

#include <cmath>

#include "coast/noise/estimable.hpp"

namespace coast::noise {

/// For processes whose block has one factor, exp(u[0]), on all its variances: the derivative is the block's own variances.
[[nodiscard]] inline SampleBlock variances_of(SampleBlock block) {
  block.Phi.setZero();
  return block;
}

/// Range of log(variance): from invisible to more than the variance of the signal.
[[nodiscard]] inline Interval log_variance_range(double variance) {
  return {std::log(variance) - 25.0, std::log(variance) + 7.0};
}

}  // namespace coast::noise
