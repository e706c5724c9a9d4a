#pragma once
// Seeded random numbers: every process of every axis has its own generator, so that adding one changes no other.

#include <cstdint>
#include <initializer_list>
#include <random>

namespace coast::simulate {

/// A seed for the stream named by `path`, from the run's seed. Finaliser of SplitMix64, Steele, Lea, Flood (2014), fig. 13.
[[nodiscard]] inline std::uint64_t stream_seed(std::uint64_t seed, std::initializer_list<std::uint64_t> path) {
  const auto mix = [](std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  };
  std::uint64_t state = mix(seed);
  for (const std::uint64_t step : path) state = mix(state ^ mix(step));
  return state;
}

/// Independent standard normal numbers.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return distribution_(engine_); }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> distribution_;
};

}  // namespace coast::simulate
