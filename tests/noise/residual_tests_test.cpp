#include "coast/noise/residual_tests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace coast::noise {
namespace {

std::vector<double> sines_of_squares() {
  std::vector<double> x;
  for (int i = 1; i <= 200; ++i) x.push_back(std::sin(static_cast<double>(i) * i));
  return x;
}

// R 4.2.2, x <- sin((1:200)^2): Box.test(x, lag, "Ljung-Box", fitdf); for arch_lm R^2 of lm on embed(x^2, lags + 1), times its
// rows; for jarque_bera the formula typed in, with pchisq. Fifteen digits printed.
TEST(ResidualTests, AreThoseOfR) {
  const std::vector<double> x = sines_of_squares();
  const auto expect_test = [](const ResidualTest& test, double statistic, double p_value) {
    EXPECT_NEAR(test.statistic, statistic, 1e-10 * statistic);
    EXPECT_NEAR(test.p_value, p_value, 1e-10 * p_value);
  };
  expect_test(ljung_box(x, 1), 0.430133035419175, 0.511923677015697);
  expect_test(ljung_box(x, 10), 4.59594127118927, 0.916486339986224);
  expect_test(ljung_box(x, 10, 3), 4.59594127118927, 0.70913565119258);
  expect_test(arch_lm(x, 1), 0.87916134101841, 0.348431484234867);
  expect_test(arch_lm(x, 5), 1.77808889190404, 0.878918734013069);
  expect_test(jarque_bera(x), 18.8760019046253, 7.96394525928077e-05);
}

/// Largest distance between the distribution of p and a uniform one: Kolmogorov & Smirnov.
double distance_from_uniform(std::vector<double> p) {
  std::ranges::sort(p);
  const auto n = static_cast<double>(p.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto below = static_cast<double>(i);
    distance = std::max({distance, p[i] - below / n, (below + 1.0) / n - p[i]});
  }
  return distance;
}

TEST(ResidualTests, PValuesAreUniformForNormalResiduals) {
  constexpr std::size_t kRuns = 500;
  constexpr std::size_t kSamples = 8000;
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  std::vector<double> white, constant, gaussian;
  for (std::size_t run = 0; run < kRuns; ++run) {
    std::vector<double> e(kSamples);
    for (double& value : e) value = normal(generator);
    white.push_back(ljung_box(e, 10).p_value);
    constant.push_back(arch_lm(e, 3).p_value);
    gaussian.push_back(jarque_bera(e).p_value);
  }
  const double bound = 1.95 / std::sqrt(static_cast<double>(kRuns));  // 99.9 %
  EXPECT_LT(distance_from_uniform(white), bound);
  EXPECT_LT(distance_from_uniform(constant), bound);
  EXPECT_LT(distance_from_uniform(gaussian), bound);
}

TEST(ResidualTests, SeeWhatTheyAreFor) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::vector<double> coloured(3000), clustered(3000), skewed(3000);
  for (std::size_t t = 1; t < coloured.size(); ++t) {
    coloured[t] = 0.15 * coloured[t - 1] + normal(generator);
    clustered[t] = std::sqrt(0.7 + 0.3 * clustered[t - 1] * clustered[t - 1]) * normal(generator);
    skewed[t] = std::exp(0.2 * normal(generator));
  }
  skewed[0] = 1.0;
  EXPECT_LT(ljung_box(coloured, 10).p_value, 1e-6);
  EXPECT_LT(arch_lm(clustered, 3).p_value, 1e-6);
  EXPECT_LT(jarque_bera(skewed).p_value, 1e-6);
  EXPECT_GT(arch_lm(coloured, 3).p_value, 1e-4);
  EXPECT_GT(jarque_bera(coloured).p_value, 1e-4);
}

TEST(ResidualTests, RefuseWhatHasNoAnswer) {
  const std::vector<double> x = sines_of_squares();
  const std::vector<double> alike(100, 0.3);
  EXPECT_THROW(static_cast<void>(ljung_box(x, 0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(ljung_box(x, 200)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(ljung_box(x, 3, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(ljung_box(alike, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(arch_lm(x, 0)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(arch_lm(x, 100)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(arch_lm(alike, 2)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(jarque_bera(alike)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(jarque_bera({x.data(), 3})), std::invalid_argument);
}

}  // namespace
}  // namespace coast::noise
