// Likelihood, gradient, EM pass and whole estimate of three hours at 100 Hz under two Gauss-Markov processes and white noise,
// one core, beside a filter as in the textbook.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "coast/noise/calibration.hpp"

namespace {

using namespace coast::noise;  // NOLINT(google-build-using-namespace): one program, no header

constexpr double kInterval = 0.01;  // s
constexpr std::uint64_t kSamples = 1080000;

/// Stebler et al. (2011), section II.E.
SumModel model() {
  return {{&estimable("white_noise"), &estimable("gauss_markov"), &estimable("gauss_markov")}, Mean::kLevel};
}
std::vector<double> truth() {
  return {std::log(3.6e-7), std::log(4e-4), std::log(4e-8), std::log(0.1), std::log(1e-8)};
}
const StaticSignal& record() {
  static const StaticSignal signal = realisation(model(), truth(), kInterval, kSamples, 1);
  return signal;
}
const Likelihood& likelihood() {
  static const Likelihood all({record()}, model());
  return all;
}

void per_sample(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}

void value(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(likelihood().value(truth()).log_likelihood);
  per_sample(state);
}

void gradient(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(likelihood().slope(truth()).log_likelihood);
  per_sample(state);
}

void em_pass(benchmark::State& state) {
  std::vector<double> memory;
  for (auto _ : state) benchmark::DoNotOptimize(likelihood().expectation(truth(), memory).log_likelihood);
  per_sample(state);
}

/// From the record to the maximum: Allan curve, wavelet moments, search on block means, all samples.
void to_convergence(benchmark::State& state) {
  int passes = 0;
  for (auto _ : state) {
    const Likelihood fresh({record()}, model());
    const std::vector<double> start =
        fit_curve(allan_curve(fresh.records().front().signal), model(), fresh.scale(), CurveFit::kWaveletMoments);
    const Fit fit = fit_maximum_likelihood(fresh, start);
    benchmark::DoNotOptimize(fit.log_likelihood);
    passes = fit.passes;
  }
  state.counters["passes"] = passes;
}

/// A sensor with a filter of its own on a table that rings: ten states, fifteen parameters.
void gradient_ringing(benchmark::State& state) {
  const SumModel sum({&estimable("ar(2)"), &estimable("ar(2)"), &estimable("ar(2)"), &estimable("ar(2)"),
                      &estimable("gauss_markov"), &estimable("random_walk")},
                     Mean::kLevel);
  std::vector<double> u{std::atanh(0.15), std::atanh(-0.03), std::log(1.4e-3)};
  for (const double frequency : {0.56, 1.68, 10.0}) {
    const double r = std::exp(-std::numbers::pi * 0.02 * frequency * kInterval);
    const double first = 2.0 * r * std::cos(2.0 * std::numbers::pi * frequency * kInterval) / (1.0 + r * r);
    u.insert(u.end(), {std::atanh(first), std::atanh(-r * r), std::log(4e-5 * (1.0 - first * first) * (1.0 - r * r * r * r))});
  }
  u.insert(u.end(), {std::log(0.1), std::log(2e-5), std::log(2e-7)});
  const Likelihood ringing({realisation(sum, u, kInterval, kSamples, 2)}, sum);
  for (auto _ : state) benchmark::DoNotOptimize(ringing.slope(u).log_likelihood);
  per_sample(state);
}

/// The textbook's filter for the value alone: no stationary gain, matrices of any size.
void textbook_value(benchmark::State& state) {
  const SampleBlock block = model().block(truth(), kInterval);
  for (auto _ : state) {
    Eigen::MatrixXd P = block.P_first;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(block.h.size());
    double sum = 0.0;
    for (const double y : record().values) {
      const double e = y - block.h.dot(x);
      const double S = (block.h * P * block.h.transpose()).value() + block.white;
      const Eigen::VectorXd k = P * block.h.transpose() / S;
      sum -= 0.5 * (std::log(2.0 * std::numbers::pi * S) + e * e / S);
      x = block.Phi * (x + k * e);
      P = block.Phi * (P - k * S * k.transpose()) * block.Phi.transpose() + block.Q;
    }
    benchmark::DoNotOptimize(sum);
  }
  per_sample(state);
}

BENCHMARK(value)->Unit(benchmark::kMillisecond);
BENCHMARK(gradient)->Unit(benchmark::kMillisecond);
BENCHMARK(em_pass)->Unit(benchmark::kMillisecond);
BENCHMARK(to_convergence)->Unit(benchmark::kMillisecond);
BENCHMARK(gradient_ringing)->Unit(benchmark::kMillisecond);
BENCHMARK(textbook_value)->Unit(benchmark::kMillisecond);

}  // namespace
