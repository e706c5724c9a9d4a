// Allan and Hadamard variance of signals with holes: averages that have at least three quarters of their samples.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coast/noise/estimators.hpp"
#include "noise/noise_samples.hpp"

namespace coast::noise {
namespace {

struct Gappy {
  std::vector<double> values;
  std::vector<bool> there;
};

Gappy gappy(std::size_t n, double lost, std::uint64_t seed) {
  Gappy gappy{test::random_walk_samples(n, 0.05, seed), std::vector<bool>(n, true)};
  for (double& value : gappy.values) value += 9.8;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  for (std::size_t i = 1; i < n; ++i) gappy.there[i] = uniform(generator) >= lost;
  for (std::size_t i = n / 3; i < n / 3 + 200; ++i) gappy.there[i] = false;  // and a long hole
  gappy.there[n - 1] = true;
  return gappy;
}

StaticSignal signal_of(const Gappy& gappy, double interval) {
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < gappy.there.size(); ++i)
    if (!gappy.there[i]) lost.push_back(i);
  return without(StaticSignal::regular(gappy.values, interval), lost);
}

/// By the definition: averages of what there is, their differences, one after the other.
struct Sums {
  double allan = 0.0, hadamard = 0.0;
  std::uint64_t allan_terms = 0, hadamard_terms = 0;
};
Sums by_definition(const Gappy& gappy, std::size_t m, std::size_t stride) {
  const auto average = [&](std::size_t from) -> std::optional<double> {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = from; i < from + m; ++i)
      if (gappy.there[i]) sum += gappy.values[i], count += 1.0;
    if (4.0 * count < 3.0 * static_cast<double>(m)) return {};
    return sum / count;
  };
  Sums sums;
  for (std::size_t i = 0; i + 2 * m <= gappy.values.size(); i += stride) {
    const auto a = average(i), b = average(i + m);
    if (!a || !b) continue;
    sums.allan += 0.5 * (*b - *a) * (*b - *a);
    ++sums.allan_terms;
    if (i < m) continue;
    const auto before = average(i - m);
    if (!before) continue;
    sums.hadamard += std::pow(*b - 2.0 * *a + *before, 2) / 6.0;
    ++sums.hadamard_terms;
  }
  return sums;
}

// Rounding: 1e-16 of an integral of some 1e4 over differences of some 1. The longest average fits three times into the record.
TEST(AllanHoles, DefinitionByBruteForceInBothModes) {
  const Gappy record = gappy(5000, 0.03, 4);
  for (const std::uint64_t full : {std::uint64_t{1} << 20U, std::uint64_t{0}}) {
    const AllanCurve curve = allan_curve(signal_of(record, 0.01), {.points_per_decade = 4, .full_overlap_samples = full});
    ASSERT_EQ(curve.back().factor, 1000U);
    for (const AllanPoint& point : curve) {
      const Sums expected = by_definition(record, point.factor, point.factor / point.overlap);
      EXPECT_EQ(point.allan.terms, expected.allan_terms) << point.factor;
      EXPECT_EQ(point.hadamard.terms, expected.hadamard_terms) << point.factor;
      const double allan = std::sqrt(expected.allan / static_cast<double>(expected.allan_terms));
      const double hadamard = std::sqrt(expected.hadamard / static_cast<double>(expected.hadamard_terms));
      EXPECT_NEAR(point.allan.value, allan, 1e-10 * allan) << point.factor;
      EXPECT_NEAR(point.hadamard.value, hadamard, 1e-10 * hadamard) << point.factor;
    }
  }
}

// Where one sample is missing the curve is that of the whole record but for the terms that the sample is in: of averages of one
// sample these are two of 2000, of long ones all, whose averages change by some 1/m of their scatter.
TEST(AllanHoles, OneLostSampleHardlyChangesTheCurve) {
  const std::vector<double> y = test::random_walk_samples(2000, 0.05, 9);
  const std::vector<std::size_t> lost{777};
  const StaticSignal whole = StaticSignal::regular(y, 1.0);
  const AllanCurve a = allan_curve(whole), b = allan_curve(without(whole, lost));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(b[i].allan.value / a[i].allan.value, 1.0, 0.02) << a[i].factor;
}

// Averages of n of m samples of white noise have the variance 1/n: 1/(m (1 - p)) where a share p is lost here and there.
TEST(AllanHoles, WhiteNoiseIsThatOfTheSamplesThatAreThere) {
  const double lost = 0.1;
  Gappy record{test::white_samples(400000, 3), std::vector<bool>(400000, true)};
  std::mt19937_64 generator(8);
  std::uniform_real_distribution<double> uniform;
  for (std::size_t i = 0; i < record.there.size(); ++i) record.there[i] = uniform(generator) >= lost;
  record.there.front() = record.there.back() = true;
  for (const AllanPoint& point : allan_curve(signal_of(record, 1.0))) {
    if (point.factor < 100 || point.factor > 1000) continue;
    const double variance = point.allan.value * point.allan.value * static_cast<double>(point.factor);
    EXPECT_NEAR(variance * (1.0 - lost), 1.0, 4.0 * std::sqrt(2.0 / point.allan.edf) + 0.002) << point.factor;  // E 1/n > 1/E n
  }
}

TEST(AllanHoles, BlockMeansOfWhatIsThere) {
  std::vector<double> y(20);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = static_cast<double>(i);
  const std::vector<std::size_t> lost{5, 8, 9};
  const StaticSignal blocks = block_means(without(StaticSignal::regular(y, 0.5), lost), 4, 0.75);
  ASSERT_EQ(blocks.values, (std::vector<double>{1.5, 17.0 / 3.0, 13.5, 17.5}));  // of 8 to 11 half is missing
  ASSERT_EQ(blocks.runs.size(), 2U);
  EXPECT_EQ(blocks.runs[1].start, 3U);
}

}  // namespace
}  // namespace coast::noise
