#pragma once
// Standard normal deviates, a few nanoseconds each. Private to the room.

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace coast::noise {

/// The ziggurat of Marsaglia & Tsang (2000) as in Doornik (2005, "An improved ziggurat method to generate normal random
/// samples"): 128 layers of equal area, index and position from different bits. The same numbers for the same seed everywhere.
class NormalDraws {
 public:
  explicit NormalDraws(std::uint64_t seed) : generator_(seed) {
    double density = std::exp(-0.5 * kTail * kTail);
    edge_[0] = kArea / density;
    edge_[1] = kTail;
    for (std::size_t i = 2; i < kLayers; ++i) {
      edge_[i] = std::sqrt(-2.0 * std::log(kArea / edge_[i - 1] + density));
      density = std::exp(-0.5 * edge_[i] * edge_[i]);
    }
    edge_[kLayers] = 0.0;
    for (std::size_t i = 0; i < kLayers; ++i) inside_[i] = edge_[i + 1] / edge_[i];
  }

  double operator()() {
    for (;;) {
      const std::uint64_t bits = generator_();
      const std::size_t layer = bits % kLayers;
      const double along = 2.0 * unit(bits) - 1.0;
      if (std::abs(along) < inside_[layer]) return along * edge_[layer];
      if (layer == 0) return std::copysign(beyond_tail(), along);
      const double x = along * edge_[layer];
      const double outer = std::exp(-0.5 * (edge_[layer] * edge_[layer] - x * x));
      const double inner = std::exp(-0.5 * (edge_[layer + 1] * edge_[layer + 1] - x * x));
      if (inner + unit(generator_()) * (outer - inner) < 1.0) return x;
    }
  }

 private:
  static constexpr std::size_t kLayers = 128;
  static constexpr double kTail = 3.442619855899;       // start of the lowest layer's tail
  static constexpr double kArea = 9.91256303526217e-3;  // of every layer
  static double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1p-53; }

  double beyond_tail() {
    for (;;) {
      const double x = std::log(1.0 - unit(generator_())) / kTail;
      const double y = std::log(1.0 - unit(generator_()));
      if (-2.0 * y >= x * x) return kTail - x;
    }
  }

  std::mt19937_64 generator_;
  std::array<double, kLayers + 1> edge_{};
  std::array<double, kLayers> inside_{};
};

}  // namespace coast::noise
