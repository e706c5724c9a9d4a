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
/// A stationary Gauss-Markov process of unit variance.  @param b beta times the sample interval  @param m samples per block
///
///     x' = phi^m x + zeta,    mean' = x phi (1 - phi^m)/(m (1 - phi)) + eta
[[nodiscard]] AveragedBlock averaged_gauss_markov(double b, std::size_t m);

/// The same in one state: means of different blocks have the covariance `common` phi^(m lag), as in a Gauss-Markov process;
/// the mean of a block has the additional variance `alone`, which is negative: the excess of the state.
struct AveragedVariances {
  double common = 0.0;
  double alone = 0.0;
};
/// @note beyond 12 correlation times per block the covariance of neighbours is left out: 1/23 of the variance at most
[[nodiscard]] AveragedVariances averaged_variances(double b, std::size_t m);

/// A random walk of unit variance per sample that is zero at its first sample.
[[nodiscard]] SampleBlock averaged_random_walk(std::size_t m);

}  // namespace coast::noise
