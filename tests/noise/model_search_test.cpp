// Which sum of processes is found for records whose sum is known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "coast/noise/calibration.hpp"
#include "noise/noise_samples.hpp"
#include "noise/static_record.hpp"

namespace coast::noise {
namespace {

using test::logs;
using test::sum;

/// Sums that are found in place of the right one.
std::vector<std::string> wrong_sums(const SumModel& truth, const std::vector<double>& u, double interval, std::uint64_t length,
                                    std::size_t draws) {
  std::vector<std::string> wrong;
  for (std::size_t seed = 1; seed <= draws; ++seed) {
    const AxisCalibration result = calibrate({realisation(truth, u, interval, length, seed)}, {.realisations = 60});
    if (result.best().model.name() != truth.name()) wrong.push_back(std::to_string(seed) + ": " + result.best().model.name());
  }
  return wrong;
}

// Of white noise every sample tells: their logarithm is what Schwarz' criterion takes. Of a Gauss-Markov process that the white
// noise leaves bare n samples tell as much as the information matrix says, here in the limit of many correlation times: log
// sigma^2 has the variance 2/n (1 + phi^2)/(1 - phi^2) in n samples at most (both parameters free, Priestley 1981, sec. 5.4).
TEST(ModelSearch, CountsTheIndependentSquaresThatTellOfAParameter) {
  const std::uint64_t n = 8000;
  const SumModel white = sum({"white_noise"}, Mean::kLevel);
  const AxisCalibration one = calibrate({realisation(white, logs({1.0}), 1.0, n, 3)},
                                        {.processes = {"white_noise"}, .mean = Mean::kLevel, .realisations = 0});
  ASSERT_EQ(one.best().independent.size(), 1U);
  EXPECT_NEAR(one.best().independent[0], static_cast<double>(n), 1e-3 * static_cast<double>(n));
  EXPECT_NEAR(one.best().bic, -2.0 * one.best().compared_log_likelihood + 2.0 * std::log(static_cast<double>(n)), 0.01);

  const double beta = 0.02;
  const double phi = std::exp(-beta);
  const SumModel markov = sum({"gauss_markov"}, Mean::kLevel);
  const AxisCalibration two = calibrate({realisation(markov, logs({beta, 1.0}), 1.0, n, 4)},
                                        {.processes = {"gauss_markov"}, .mean = Mean::kLevel, .realisations = 0});
  const double expected = static_cast<double>(n) * (1.0 - phi * phi) / (1.0 + phi * phi);
  ASSERT_EQ(two.best().independent.size(), 2U);
  // 160 correlation times: beta is known to 11 %, and both sides go with it; four of these.
  EXPECT_NEAR(std::log(two.best().independent[1] / expected), 0.0, 0.45);
}

// 30 min with 36 correlation times: a random walk fits nearly as well. With log(samples) for a parameter half the records had
// one; in 98 of 100 draws twice the log-likelihood of a Gauss-Markov process is higher by 6.63, which it costs. Quantisation
// costs log(samples): with less two of these draws had one.
TEST(ModelSearch, TellsALongGaussMarkovProcessFromARandomWalk) {
  const auto wrong = wrong_sums(sum({"white_noise", "gauss_markov"}, Mean::kLevel), logs({1e-6, 0.02, 3.6e-7}), 0.2, 9000, 12);
  EXPECT_LE(wrong.size(), 1U) << testing::PrintToString(wrong);
}

TEST(ModelSearch, FindsARandomWalkBesideAGaussMarkovProcess) {
  const auto wrong = wrong_sums(sum({"white_noise", "gauss_markov", "random_walk"}, Mean::kLevel),
                                logs({1e-6, 0.2, 2.25e-6, 4e-8}), 0.2, 9000, 3);
  EXPECT_TRUE(wrong.empty()) << testing::PrintToString(wrong);
}

// An hour with the floor of its Allan curve at 0.664 x 3e-4, above its white noise from 25 s on.
TEST(ModelSearch, FindsFlickerNoise) {
  const auto wrong = wrong_sums(sum({"white_noise", "flicker"}, Mean::kLevel), logs({1e-6, 9e-8}), 0.4, 9000, 4);
  EXPECT_LE(wrong.size(), 1U) << testing::PrintToString(wrong);
}

// Flicker noise that is no sum of Gauss-Markov processes: fractional differences (Kasdin 1995).
TEST(ModelSearch, FindsFlickerNoiseOfAnotherMake) {
  std::vector<double> flicker = test::flicker_samples(6000, 5);
  const std::vector<double> white = test::white_samples(6000, 6);
  // h_k ~ k^-1/2/sqrt(pi): S = 1/(2 pi f), B = 1; the white noise is above it up to some 15 samples.
  for (std::size_t i = 0; i < flicker.size(); ++i) flicker[i] += 2.5 * white[i];
  const AxisCalibration result = calibrate({StaticSignal::regular(flicker, 1.0)}, {.realisations = 60});
  EXPECT_EQ(result.best().model.name(), "WN + BI + level");
  EXPECT_TRUE(result.band.inside);
}

TEST(ModelSearch, FindsRoundingOfTheIntegral) {
  const auto wrong = wrong_sums(sum({"white_noise", "quantisation"}, Mean::kLevel), logs({1e-6, 8e-8}), 0.1, 9000, 3);
  EXPECT_TRUE(wrong.empty()) << testing::PrintToString(wrong);
}

// Two sums and one that has both: whatever a sum is stated beside, its likelihood is not below that of its parts.
TEST(StatedSum, IsNeverBelowTheSumsOfSomeOfItsProcesses) {
  const SumModel truth = sum({"ar(1)", "gauss_markov"}, Mean::kLevel);
  const std::vector<std::vector<std::string>> parts{
      {"ar(1)"}, {"ar(1)", "gauss_markov"}, {"ar(1)", "random_walk"}, {"gauss_markov", "random_walk"}};
  for (const std::uint64_t length : {std::uint64_t{5000}, std::uint64_t{50000}}) {  // as it is, and by extracts first
    std::vector<double> u = logs({0.0, 1.0, 0.005, 0.04});
    u[0] = std::atanh(0.15);
    const StaticSignal record = realisation(truth, u, 1.0, length, 7);
    const auto likelihood_of = [&](const std::vector<std::string>& processes) {
      return calibrate({record}, {.processes = processes, .mean = Mean::kLevel, .realisations = 0}).best().fit.log_likelihood;
    };
    const double whole = likelihood_of({"ar(1)", "gauss_markov", "random_walk"});
    for (const auto& part : parts)
      EXPECT_GT(whole, likelihood_of(part) - 1e-4) << part.front() << part.size() << " of " << length;
  }
}

StaticSignal with_losses(const StaticSignal& whole, double share, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < whole.values.size(); ++i)
    if (uniform(generator) < share) lost.push_back(i);
  return without(whole, lost);
}

// One sample of a hundred lost: no stretch of it is longer than some hundred samples.
TEST(ModelSearch, LossesHereAndThereLeaveCurveAndSumAsTheyWere) {
  const SumModel truth = sum({"white_noise", "gauss_markov"}, Mean::kLevel);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const StaticSignal whole = realisation(truth, logs({1e-6, 0.2, 1e-6}), 0.1, 12000, seed);
    const StaticSignal record = with_losses(whole, 0.01, seed);
    const AxisCalibration result = calibrate({record}, {.realisations = 60});
    EXPECT_EQ(result.best().model.name(), truth.name()) << seed;
    EXPECT_TRUE(result.band.inside) << seed;
    EXPECT_EQ(result.curves[0].back().factor, allan_curve(whole).back().factor);
  }
}

// Of realisations at known parameters the band's middle is the closed form: the mean of a logarithm is below the logarithm of a
// mean by half the variance, which is 2/edf; 400 realisations know it to sd/20, of which four.
TEST(CurveBand, IsAboutTheClosedFormWithAndWithoutHoles) {
  const SumModel model = sum({"white_noise", "gauss_markov", "ar(2)"}, Mean::kLevel);
  std::vector<double> u = logs({1.0, 0.005, 1.0, 1.0, 1.0, 0.5});
  u[3] = std::atanh(0.6);
  u[4] = std::atanh(-0.3);
  const StaticSignal whole = realisation(model, u, 1.0, 6000, 1);
  for (const StaticSignal& record : {whole, with_losses(whole, 0.002, 2)}) {
    const RecordTest test = test_on(record, model, u, {.realisations = 400});
    const std::vector<ProcessPtr> processes = model.processes(u, {Sensor::kGyro, 1.0});
    for (std::size_t i = 0; i < test.band.tau.size(); ++i) {
      const double edf = test.curve[i].allan.edf;
      if (edf < 20.0) continue;
      const double expected = std::sqrt(allan_variance(processes, test.band.tau[i]));
      const double sd = 1.0 / std::sqrt(2.0 * edf);
      // Beside that 0.2 % more white noise with holes, samples in the place of means over the interval (beta sigma^2/3 of
      // 3.4 in the variance), and edf by the nearest power law: a quarter of the bias.
      EXPECT_NEAR(std::log(test.band.median[i] / expected), -0.5 / edf, 4.0 * sd / 20.0 + 0.001 + 0.25 / edf)
          << test.band.tau[i];
    }
  }
}

}  // namespace
}  // namespace coast::noise
