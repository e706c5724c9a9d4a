// Estimate of an ARMA(3,2)-GARCH(1,1) from 5000 and 20 000 samples with and without its standard deviations, one core; fgarch.R
// times the same by fGarch.

#include <benchmark/benchmark.h>

#include "coast/noise/arma_garch_filter.hpp"

namespace {

using namespace coast::noise;  // NOLINT(google-build-using-namespace): one program, no header

/// Every coefficient inside (-1, 1), where fGarch keeps them; fgarch.R simulates the same.
ArmaGarch truth() {
  return {.nu = 0.02, .alpha = {0.9, -0.55, 0.3}, .beta = {0.6, 0.25}, .gamma0 = 0.05, .gamma = {0.08}, .delta = {0.87}};
}
std::vector<double> series(std::int64_t n) {
  std::mt19937_64 generator(1);
  return simulate_arma_garch(truth(), static_cast<std::size_t>(n), generator);
}

void fit(benchmark::State& state) {
  const std::vector<double> y = series(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(fit_arma_garch({y}, truth().orders()).log_likelihood);
}

void fit_with_deviations(benchmark::State& state) {
  const std::vector<double> y = series(state.range(0));
  for (auto _ : state) {
    const ArmaGarchFit found = fit_arma_garch({y}, truth().orders());
    benchmark::DoNotOptimize(arma_garch_uncertainty(found, {y}));
  }
}

void gradient(benchmark::State& state) {
  const std::vector<double> y = series(state.range(0));
  const ArmaGarch model = truth();
  for (auto _ : state) benchmark::DoNotOptimize(arma_garch_gradient(model, {y}).data());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void filter(benchmark::State& state) {
  const std::vector<double> y = series(state.range(0));
  ArmaGarchFilter running(truth());
  for (auto _ : state) {
    for (const double value : y) running.observe(value);
    benchmark::DoNotOptimize(running.prediction().mean);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(fit)->Arg(5000)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(fit_with_deviations)->Arg(5000)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(gradient)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK(filter)->Arg(20000)->Unit(benchmark::kMicrosecond);

}  // namespace
