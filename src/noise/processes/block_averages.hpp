#pragma once
// Means of m samples of a first-order process, exactly: the state carries the last sample of a block and the block's mean.
// Private to the room.

#include <Eigen/Core>

#include "coast/noise/estimable.hpp"

namespace coast::noise {

/// With phi = exp(-b), sigma2 = 1, and its derivative with respect to log b.
struct AveragedBlock {
  SampleBlock value;
  SampleBlock slope;
};
/// A stationary Gauss-Markov process of unit variance.  @param b beta times the sample interval  @param m samples of a block
///
///     x' = phi^m x + zeta,    mean' = x phi (1 - phi^m)/(m (1 - phi)) + eta
[[nodiscard]] AveragedBlock averaged_gauss_markov(double b, std::size_t m);

/// A random walk of unit variance per sample that is zero at its first sample.
[[nodiscard]] SampleBlock averaged_random_walk(std::size_t m);

}  // namespace coast::noise
