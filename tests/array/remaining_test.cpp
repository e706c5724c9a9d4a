#include "coast/array/remaining.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "array/noisy_array.hpp"
#include "coast/io/yaml.hpp"
#include "coast/noise/error_model.hpp"

namespace coast::array {
namespace {

/// Adds a Gauss-Markov process to every sensor's first channel, each its own: exact recursion.
void add_gauss_markov(Signals& signals, double sigma, double time_s, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const double phi = std::exp(-signals.dt / time_s);
  for (SensorSignals& sensor : signals.sensors) {
    double x = sigma * normal(generator);
    for (Eigen::Index n = 0; n < sensor.values.cols(); ++n) {
      sensor.values(0, n) += x;
      x = phi * x + sigma * std::sqrt(1.0 - phi * phi) * normal(generator);
    }
  }
}

double variance_of(const noise::Process& process) {
  Eigen::MatrixXd P(1, 1);
  process.initial_covariance(P);
  return P(0, 0);
}

TEST(RemainingErrors, AreThoseOfTheMean) {
  Signals signals = test::noisy_array({0.1, 0.1, 0.1, 0.1}, 180000, 1);
  add_gauss_markov(signals, 0.02, 60.0, 2);
  const RemainingErrors found = remaining_errors(signals, 0, 1.0, 1.0);
  ASSERT_EQ(found.processes.size(), 3U) << found.in_words;
  // The mean of four: a quarter of the variances. 1800 averages of four sensors know the white density to 3 %.
  double white = 0.0;
  double slow = 0.0;
  for (const noise::ProcessPtr& process : found.processes) {
    white += process->white_density().value;
    if (process->name() == "gauss_markov") slow = variance_of(*process);
  }
  EXPECT_NEAR(white / (0.01 * signals.dt / 4.0), 1.0, 0.12);
  // 30 correlation times in three independent records know a variance to sqrt(2/45) = 21 %; three sigmas.
  EXPECT_NEAR(slow / (4e-4 / 4.0), 1.0, 0.65);
}

TEST(RemainingErrors, AreWhiteWhereNothingIsSlow) {
  const Signals signals = test::noisy_array({0.1, 0.1, 0.1}, 60000, 3);
  const RemainingErrors found = remaining_errors(signals, 2, 1.0, 0.5);
  ASSERT_EQ(found.processes.size(), 2U) << found.in_words;
  EXPECT_NEAR(found.processes[0]->white_density().value / (0.5 * 0.01 * signals.dt / 3.0), 1.0, 0.15);
}

TEST(RemainingErrors, OfLevelsThatScatter) {
  Signals signals = test::noisy_array({0.001, 0.001, 0.001}, 20000, 4);
  const std::array<double, 3> level{0.3, -0.1, 0.1};  // variance about their mean 0.04; of the mean a third
  for (std::size_t k = 0; k < 3; ++k) signals.sensors[k].values.row(4).array() += level[k];
  const RemainingErrors found = remaining_errors(signals, 4, 0.2, 1.0);
  EXPECT_EQ(found.processes.back()->name(), "random_constant");
  EXPECT_NEAR(variance_of(*found.processes.back()), 0.04 / 3.0, 3e-6);  // levels known to 0.001 / sqrt(20000)
}

TEST(RemainingErrors, OfAShortRecordAreOfShorterMeans) {
  // 44 s: means of half a second. A variance from 88 times two independent squares, five sd.
  const Signals signals = test::noisy_array({0.1, 0.1, 0.1}, 4400, 6);
  const RemainingErrors found = remaining_errors(signals, 1, 1.0, 1.0);
  EXPECT_NEAR(found.processes[0]->white_density().value / (0.01 * signals.dt / 3.0), 1.0, 5.0 * std::sqrt(2.0 / 176.0));
  const Signals shorter = test::noisy_array({0.1, 0.1, 0.1}, 450, 6);
  EXPECT_THROW(static_cast<void>(remaining_errors(shorter, 1, 1.0, 1.0)), std::invalid_argument) << "45 means of 0.1 s";
}

TEST(RemainingErrors, BecomeAModelThatTheFilterReads) {
  const Signals signals = test::noisy_array({0.1, 0.1, 0.1}, 20000, 5);
  std::vector<RemainingErrors> channels;
  for (int c = 0; c < kChannels; ++c) channels.push_back(remaining_errors(signals, c, 0.5, 1.0));
  const std::string text = error_model_yaml("three", 100.0, channels);
  const noise::ImuErrorModel model = noise::ImuErrorModel::from(io::parse_yaml(text, "error_model.yaml"));
  EXPECT_NEAR(model.white_density(noise::Sensor::kAccel, 1).value / (0.01 * signals.dt / 3.0), 1.0, 0.2);
}

}  // namespace
}  // namespace coast::array
