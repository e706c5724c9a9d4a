// The estimator: published tables, the definitions by brute force, models by simulation, blocks against full overlap.

#include "coast/noise/allan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "coast/io/input.hpp"
#include "coast/noise/chi_square.hpp"
#include "noise/entries.hpp"
#include "noise/noise_samples.hpp"
#include "support/malloc_guard.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using noise::AllanAccumulator;
using noise::AllanCurve;
using noise::AllanPoint;

AllanCurve curve_of(const std::vector<double>& rates, double interval, const noise::AllanOptions& options = {}) {
  AllanAccumulator accumulator(interval, options);
  accumulator.add(rates);
  return accumulator.finish();
}

// W. Riley, Handbook of Frequency Stability Analysis, NIST Special Publication 1065 (2008), table 31: all seven digits of the
// overlapping Allan and Hadamard deviations of the 1000-point set; the set itself from eq. (73).
TEST(Allan, Nist1000PointSet) {
  std::vector<double> rates;
  for (std::uint64_t n = 1234567890; rates.size() < 1000; n = 16807 * n % 2147483647)
    rates.push_back(static_cast<double>(n) / 2147483647.0);
  const AllanCurve curve = curve_of(rates, 1.0, {.points_per_decade = 1});
  ASSERT_EQ(curve.size(), 3u);
  const double allan[] = {2.922319e-1, 9.159953e-2, 3.241343e-2}, hadamard[] = {2.943883e-1, 9.581083e-2, 3.237638e-2};
  const double digit[] = {0.5e-7, 0.5e-8, 0.5e-8};
  const std::uint64_t terms[] = {999, 981, 801};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(curve[i].tau, std::pow(10.0, i));
    EXPECT_NEAR(curve[i].allan.value, allan[i], digit[i]);
    EXPECT_NEAR(curve[i].hadamard.value, hadamard[i], digit[i]);
    EXPECT_EQ(curve[i].allan.terms, terms[i]);
    EXPECT_EQ(curve[i].noise, noise::NoiseType::kWhite);
  }
}

// The same, table 30: the nine frequencies of NBS Monograph 140.
TEST(Allan, NbsNinePointSet) {
  const AllanCurve curve = curve_of({892, 809, 823, 798, 671, 644, 883, 903, 677}, 1.0, {.points_per_decade = 3});
  ASSERT_GE(curve.size(), 2u);
  ASSERT_EQ(curve[1].factor, 2u);
  EXPECT_NEAR(curve[0].allan.value, 91.22945, 0.5e-5);
  EXPECT_NEAR(curve[1].allan.value, 85.95287, 0.5e-5);
  EXPECT_NEAR(curve[0].hadamard.value, 70.80607, 0.5e-5);
  EXPECT_NEAR(curve[1].hadamard.value, 85.61487, 0.5e-5);
}

/// Sums over a run by the definition: averages, their differences, one after the other.
struct ByDefinition {
  double allan = 0.0, hadamard = 0.0;
  std::uint64_t allan_terms = 0, hadamard_terms = 0;

  void add(const std::vector<double>& run, std::size_t m, std::size_t stride) {
    const auto mean = [&](std::size_t from) {
      long double sum = 0.0L;
      for (std::size_t i = 0; i < m; ++i) sum += run[from + i];
      return static_cast<double>(sum / static_cast<long double>(m));
    };
    for (std::size_t t = 0; t + 2 * m <= run.size(); t += stride, ++allan_terms)
      allan += std::pow(mean(t + m) - mean(t), 2) / 2.0;
    for (std::size_t t = 0; t + 3 * m <= run.size(); t += stride, ++hadamard_terms)
      hadamard += std::pow(mean(t + 2 * m) - 2.0 * mean(t + m) + mean(t), 2) / 6.0;
  }
};

// Runs between gaps, one of them too short for anything, on top of gravity. Rounding: 1e-16 of the integral, 1e5 steps.
TEST(Allan, DefinitionByBruteForceOverGapsInBothModes) {
  for (const std::uint64_t full : {std::uint64_t{1} << 20U, std::uint64_t{0}}) {
    std::vector<std::vector<double>> runs;
    AllanAccumulator accumulator(0.02, {.points_per_decade = 4, .full_overlap_samples = full});
    for (const std::size_t length : {3000U, 2U, 7001U, 2433U}) {
      runs.push_back(test::random_walk_samples(length, 0.1, length));
      for (double& rate : runs.back()) rate -= 9.8;
      accumulator.add(runs.back());
      accumulator.gap();
    }
    EXPECT_EQ(accumulator.samples(), 12436u);
    const AllanCurve curve = accumulator.finish();
    ASSERT_GT(curve.back().factor, 1500u);
    for (const AllanPoint& point : curve) {
      EXPECT_EQ(point.overlap, full > 0 ? point.factor : point.factor < 128 ? point.factor : point.overlap);
      EXPECT_GE(point.overlap, std::min<std::uint64_t>(point.factor, 64));
      ByDefinition expected;
      for (const auto& run : runs) expected.add(run, point.factor, point.factor / point.overlap);
      EXPECT_EQ(point.allan.terms, expected.allan_terms);
      EXPECT_EQ(point.hadamard.terms, expected.hadamard_terms);
      const double allan = std::sqrt(expected.allan / static_cast<double>(expected.allan_terms));
      const double hadamard = std::sqrt(expected.hadamard / static_cast<double>(expected.hadamard_terms));
      EXPECT_NEAR(point.allan.value, allan, 1e-11 * allan) << point.factor;
      EXPECT_NEAR(point.hadamard.value, hadamard, 1e-11 * hadamard) << point.factor;
    }
  }
}

// Percival & Walden (2000) sec. 5.5: maximal-overlap transform with the Haar filter, level by level; coefficients that see the
// ends are left out.
TEST(Allan, HaarWaveletVarianceIsThatOfTheTransform) {
  const std::vector<double> rates = test::random_walk_samples(1500, 0.3, 5);
  const AllanCurve curve = curve_of(rates, 1.0, {.points_per_decade = 200});  // so dense that every power of two is among them
  std::vector<double> smooth = rates;
  for (std::size_t m = 1; m <= 256; m *= 2) {
    double sum = 0.0;
    std::vector<double> next(smooth.size());
    for (std::size_t t = 0; t < rates.size(); ++t) {
      const double before = smooth[(t + rates.size() - m) % rates.size()];
      next[t] = 0.5 * (smooth[t] + before);
      if (t + 1 >= 2 * m) sum += std::pow(0.5 * (smooth[t] - before), 2);
    }
    smooth = next;
    const double expected = sum / static_cast<double>(rates.size() - 2 * m + 1);
    const auto point = std::ranges::find(curve, m, &AllanPoint::factor);
    ASSERT_NE(point, curve.end()) << m;
    EXPECT_NEAR(point->haar_variance(), expected, 1e-12 * expected) << m;
  }
}

// The blocks' terms are a part of the full overlap's: the difference has the variance that the lost degrees of freedom say.
TEST(Allan, BlockSumsAgreeWithFullOverlapWithinWhatTheyLose) {
  const std::vector<double> rates = test::random_walk_samples(300000, 0.02, 11);
  const AllanCurve full = curve_of(rates, 0.01), blocks = curve_of(rates, 0.01, {.full_overlap_samples = 1000});
  ASSERT_EQ(full.size(), blocks.size());
  for (std::size_t i = 0; i < full.size(); ++i) {
    ASSERT_EQ(full[i].tau, blocks[i].tau);
    const noise::Deviation &a = blocks[i].allan, &b = full[i].allan;
    EXPECT_EQ(b.edf_lost, 0.0);
    EXPECT_GE(blocks[i].overlap, std::min<std::uint64_t>(full[i].factor, 64));
    EXPECT_LT(a.edf_lost, 1e-3);
    if (full[i].noise == blocks[i].noise) {
      EXPECT_NEAR(a.edf, b.edf, 1e-3 * b.edf);
    }
    // var(log sigma) = 1/(2 edf); four sigma of the difference, and rounding.
    EXPECT_NEAR(a.value, b.value, b.value * (1e-11 + 4.0 * std::sqrt(0.5 * 1e-3 / b.edf))) << full[i].factor;
    EXPECT_NEAR(blocks[i].hadamard.value, full[i].hadamard.value,
                full[i].hadamard.value * (1e-11 + 4.0 * std::sqrt(0.5e-3 / b.edf)));
  }
}

// What the terms of one block per 64 lose where they are independent from sample to sample is stated.
TEST(Allan, BlockSumsStateTheLossOnQuantisationNoise) {
  std::vector<double> rates = test::quantisation_samples(100000, 1.0, 3);
  const AllanCurve blocks = curve_of(rates, 1.0, {.full_overlap_samples = 0});
  const auto point = std::ranges::find_if(blocks, [](const AllanPoint& p) { return p.factor >= 512 && p.factor < 1024; });
  ASSERT_NE(point, blocks.end());
  EXPECT_EQ(point->noise, noise::NoiseType::kQuantisation);
  EXPECT_NEAR(point->allan.edf_lost, 1.0 - 1.0 / 8.0, 1e-3);
}

// White noise, a walk and a Gauss-Markov process: the curve's points inside chi-square bounds of the model's curve.
TEST(Allan, SimulatedProcessesFollowTheirModel) {
  const double dt = 0.1;
  std::vector<noise::ProcessPtr> model;
  for (const char* entry :
       {"{process: white_noise, density: 2, unit: rad/s/sqrt(Hz)}",
        "{process: random_walk, density: 0.01, unit: rad/s/sqrt(s)}",
        "{process: gauss_markov, sigma: 1, unit: rad/s, correlation_time_s: 20}",
        "{process: random_constant, sigma: 1, unit: rad/s}", "{process: scale_factor, sigma: 300, unit: ppm}"})
    model.push_back(test::process_of(entry, noise::Sensor::kGyro));
  std::mt19937_64 generator(17);
  std::normal_distribution<double> normal;
  const int steps = 10;  // per sample: the mean over it, from states at its steps
  const double phi = std::exp(-dt / steps / 20.0);
  double walk = 0.0, markov = normal(generator);
  AllanAccumulator accumulator(dt);
  for (int k = 0; k < 400000; ++k) {
    double sum = 0.0;
    for (int step = 0; step < steps; ++step) {
      walk += 0.01 * std::sqrt(dt / steps) * normal(generator);
      markov = phi * markov + std::sqrt(1.0 - phi * phi) * normal(generator);
      sum += walk + markov;
    }
    accumulator.add_increment(dt * sum / steps + 2.0 * std::sqrt(dt) * normal(generator));
  }
  for (const AllanPoint& point : accumulator.finish()) {
    const auto inside = [](const noise::Deviation& deviation, double variance) {
      const double chi2 = deviation.edf * deviation.value * deviation.value / variance;
      EXPECT_LT(chi2, noise::chi2_upper_quantile(deviation.edf, 1e-4));
      EXPECT_GT(chi2, noise::chi2_upper_quantile(deviation.edf, 1.0 - 1e-4));
    };
    inside(point.allan, noise::allan_variance(model, point.tau));
    inside(point.hadamard, noise::hadamard_variance(model, point.tau));
  }
}

TEST(Allan, ARecordLeavesNothingBehindAndLongOnesTakeNoMemory) {
  AllanAccumulator accumulator(1.0, {.full_overlap_samples = 100000});
  const std::vector<double> rates = test::random_walk_samples(1 << 16, 0.1, 23);
  accumulator.add(rates);
  const AllanCurve once = accumulator.finish();
  EXPECT_EQ(accumulator.samples(), 0u);
  for (int k = 0; k < 16; ++k) accumulator.add(rates);
  {
    const test::MallocGuard guard;
    for (int k = 0; k < 12; ++k) accumulator.add(rates);
    if (test::MallocGuard::counts()) {
      EXPECT_EQ(guard.allocations(), 0);
    }
  }
  (void)accumulator.finish();
  accumulator.add(rates);
  const AllanCurve again = accumulator.finish();
  ASSERT_EQ(again.size(), once.size());
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(again[i].allan.value, once[i].allan.value);
}

TEST(Allan, WhatIsNotASampleIsRefused) {
  EXPECT_THROW(AllanAccumulator(0.0), std::invalid_argument);
  EXPECT_THROW((void)AllanAccumulator{std::numeric_limits<double>::quiet_NaN()}, std::invalid_argument);
  EXPECT_THROW((void)AllanAccumulator(1.0, {.points_per_decade = 0}), std::invalid_argument);
  AllanAccumulator accumulator(1.0);
  accumulator.add(1.0);
  accumulator.add(std::numeric_limits<double>::infinity());
  try {
    accumulator.gap();
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("sample 1 is inf"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(AllanAccumulator(1.0).finish().empty());
  EXPECT_TRUE(curve_of({1.0, 2.0}, 1.0).empty());
}

/// Run 1 of the ADIS16405 at rest: little-endian counts gx gy gz ax ay az, row by row.
std::vector<double> adis_axis(const std::string& bytes, std::size_t axis, double per_count) {
  std::vector<double> rates;
  for (std::size_t at = 2 * axis; at + 1 < bytes.size(); at += 12) {
    const auto low = static_cast<unsigned char>(bytes[at]), high = static_cast<unsigned char>(bytes[at + 1]);
    rates.push_back(per_count * static_cast<std::int16_t>(low | (high << 8)));
  }
  return rates;
}

// Three digits computed with another program at 0.01, 0.1, .. 1000 s. From 10 s on our averaging times differ by up to 0.4 %.
TEST(Allan, RecordingAtRest) {
  const auto folder = test::data_dir();
  if (!folder) GTEST_SKIP() << "COAST_DATA is not set";
  const std::string bytes = io::read_all(*folder / "adis16405-static" / "adis16405_run1.i16.gz");
  struct Axis {
    std::size_t column;
    double per_count;
    std::array<double, 6> sigma;
  };
  for (const Axis& axis : {Axis{0, 0.05, {0.319, 0.125, 0.0409, 0.0134, 0.0072, 0.0052}},
                           Axis{2, 0.05, {0.385, 0.119, 0.0387, 0.0129, 0.0082, 0.0170}},
                           Axis{3, 0.00333, {3.60e-3, 1.41e-3, 7.21e-4, 2.95e-4, 3.38e-4, 8.66e-4}},
                           Axis{5, 0.00333, {3.77e-3, 1.45e-3, 6.21e-4, 2.34e-4, 2.41e-4, 4.20e-4}}}) {
    const AllanCurve curve = curve_of(adis_axis(bytes, axis.column, axis.per_count), 0.01, {.points_per_decade = 1});
    ASSERT_EQ(curve.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
      const double digit =
          std::pow(10.0, std::floor(std::log10(axis.sigma[i])) - (axis.sigma[i] < 0.01 && axis.per_count > 0.01 ? 1 : 2));
      EXPECT_NEAR(curve[i].allan.value, axis.sigma[i], 0.5 * digit + 0.004 * axis.sigma[i])
          << axis.column << " " << curve[i].tau;
    }
  }
}

}  // namespace
}  // namespace coast
