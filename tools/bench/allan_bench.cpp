// Allan and Hadamard variance of a stream of samples, one core, beside the plain sum over one averaging time.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "coast/noise/allan.hpp"

namespace {

using namespace coast;  // NOLINT(google-build-using-namespace): one program, no header

constexpr double kInterval = 0.01;  // s
constexpr int kPointsPerDecade = 15;

/// White noise and a random walk; a block of it, repeated, is as good for timing as a record.
const std::vector<double>& block() {
  static const std::vector<double> samples = [] {
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal;
    std::vector<double> all(1U << 16U);
    double walk = 0.0;
    for (double& sample : all) {
      walk += 1e-3 * normal(generator);
      sample = walk + normal(generator);
    }
    return all;
  }();
  return samples;
}

void stream(benchmark::State& state) {
  const auto samples = static_cast<std::size_t>(state.range(0));
  double last = 0.0;
  std::size_t points = 0;
  for (auto _ : state) {
    noise::AllanAccumulator accumulator(kInterval, {.points_per_decade = kPointsPerDecade});
    for (std::size_t done = 0; done < samples; done += block().size())
      for (std::size_t i = 0; i < std::min(block().size(), samples - done); ++i) accumulator.add(block()[i]);
    const noise::AllanCurve curve = accumulator.finish();
    last = curve.back().allan.value;
    points = curve.size();
  }
  benchmark::DoNotOptimize(last);
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["averaging_times"] = static_cast<double>(points);
}

/// What one averaging time costs without blocks and lanes: the integral in memory, one loop over the second differences.
void plain_one_time(benchmark::State& state) {
  const std::size_t factor = 10;
  std::vector<double> integral(block().size() + 1);
  for (std::size_t i = 0; i < block().size(); ++i) integral[i + 1] = integral[i] + block()[i];
  for (auto _ : state) {
    double sum = 0.0;
    for (std::size_t i = 2 * factor; i < integral.size(); ++i) {
      const double difference = integral[i] - 2.0 * integral[i - factor] + integral[i - 2 * factor];
      sum += difference * difference;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(block().size()));
}

// Argument: samples.
BENCHMARK(stream)->Arg(1 << 20)->Arg(100'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_one_time)->Unit(benchmark::kMicrosecond);

}  // namespace
