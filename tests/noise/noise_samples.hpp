#pragma once
// Seeded samples of power-law noise at interval 1, for the tests of the variances.

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace coast::test {

/// White noise of variance 1: Allan variance 1/tau.
inline std::vector<double> white_samples(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> samples(n);
  for (double& sample : samples) sample = normal(generator);
  return samples;
}

/// Means over the interval of a Wiener process of density `walk`, exactly, plus white noise of variance 1:
/// Allan variance 1/tau + walk^2 tau/3. Without white noise where `white` is 0.
inline std::vector<double> random_walk_samples(std::size_t n, double walk, std::uint64_t seed, double white = 1.0) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> samples(n);
  double value = 0.0;
  for (double& sample : samples) {
    // Over the interval: the increment W, and the mean's departure from the start W/2 + V, var V = 1/12, independent.
    const double increment = normal(generator), departure = 0.5 * increment + normal(generator) / std::sqrt(12.0);
    sample = value + walk * departure + white * normal(generator);
    value += walk * increment;
  }
  return samples;
}

/// Differences of white noise of standard deviation `sigma`: Allan variance 3 sigma^2/tau^2.
inline std::vector<double> quantisation_samples(std::size_t n, double sigma, std::uint64_t seed) {
  std::vector<double> white = white_samples(n + 1, seed), samples(n);
  for (std::size_t i = 0; i < n; ++i) samples[i] = sigma * (white[i + 1] - white[i]);
  return samples;
}

/// 1/f noise: white noise through the filter (1 - z^-1)^(-1/2), cut off after n (Kasdin 1995, Proc. IEEE 83, 802).
inline std::vector<double> flicker_samples(std::size_t n, std::uint64_t seed) {
  const std::vector<double> white = white_samples(2 * n, seed);
  std::vector<double> filter(n, 1.0), samples(n, 0.0);
  for (std::size_t k = 1; k < n; ++k) filter[k] = filter[k - 1] * (static_cast<double>(k) - 0.5) / static_cast<double>(k);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < n; ++k) samples[t] += filter[k] * white[n + t - k];
  return samples;
}

}  // namespace coast::test
