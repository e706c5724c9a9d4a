#pragma once
// Sensors at rest with known noise.

#include <fmt/format.h>

#include <random>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::test {

/// White noise of the standard deviations given, the same in all channels, at 100 Hz; no motion.
inline array::Signals noisy_array(const std::vector<double>& sd, std::size_t samples, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  array::Signals signals;
  signals.dt = 0.01;
  for (std::size_t k = 0; k < sd.size(); ++k) {
    array::SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.name = fmt::format("imu{}", k + 1);
    sensor.values.resize(array::kChannels, static_cast<Eigen::Index>(samples));
    sensor.usable.assign(samples, array::kAllUsable);
    for (Eigen::Index n = 0; n < sensor.values.cols(); ++n)
      for (int c = 0; c < array::kChannels; ++c) sensor.values(c, n) = sd[k] * normal(generator);
  }
  return signals;
}

}  // namespace coast::test
