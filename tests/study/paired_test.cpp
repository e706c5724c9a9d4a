#include "coast/study/paired.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coast::study {
namespace {

TEST(StudentT, AgreesWithPublishedTable) {
  // Abramowitz and Stegun (1964), table 26.10, three decimals; 120 degrees of freedom: 1.980, normal: 1.960.
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.706, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 2), 4.303, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 3), 3.182, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 10), 2.228, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.995, 7), 3.499, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.95, 30), 1.697, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 120), 1.980, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 1000000), 1.960, 5e-4);
}

TEST(StudentT, ClosedFormsOfOneAndTwoDegrees) {
  for (const double p : {0.6, 0.9, 0.999}) {
    const double a = 2.0 * p - 1.0;
    EXPECT_NEAR(student_t_quantile(p, 1), std::tan(M_PI * (p - 0.5)), 1e-11 * std::tan(M_PI * (p - 0.5)));
    EXPECT_NEAR(student_t_quantile(p, 2), a * std::sqrt(2.0 / (1.0 - a * a)), 1e-11 * a * std::sqrt(2.0 / (1.0 - a * a)));
    EXPECT_NEAR(student_t_quantile(1.0 - p, 5), -student_t_quantile(p, 5), 1e-10);
  }
  EXPECT_NEAR(student_t_quantile(0.5, 4), 0.0, 1e-15);
  EXPECT_THROW(static_cast<void>(student_t_quantile(1.0, 4)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(student_t_quantile(0.9, 0)), std::invalid_argument);
}

// Against every one of the 2^n outcomes of n throws.
TEST(SignTest, CountsOutcomes) {
  constexpr unsigned kThrows = 12;
  for (unsigned heads = 0; heads <= kThrows; ++heads) {
    const unsigned rarer = std::min(heads, kThrows - heads);
    double as_uneven = 0.0;
    for (unsigned outcome = 0; outcome < (1u << kThrows); ++outcome) {
      const auto h = static_cast<unsigned>(__builtin_popcount(outcome));
      if (std::min(h, kThrows - h) <= rarer) as_uneven += 1.0;
    }
    EXPECT_NEAR(sign_test(heads, kThrows - heads), as_uneven / (1u << kThrows), 1e-12) << heads;
  }
  EXPECT_EQ(sign_test(0, 0), 1.0);
  EXPECT_NEAR(sign_test(30, 70), 7.85014e-5, 5e-10);  // in rational arithmetic, 6 digits
}

TEST(PairedRatio, ByHand) {
  const std::vector<double> first{1.0, 2.0, 4.0};
  const std::vector<double> second{2.0, 2.0, 2.0};  // logarithms: log 2, 0, -log 2
  const PairedRatio r = paired_ratio(first, second);
  EXPECT_EQ(r.pairs, 3U);
  EXPECT_NEAR(r.ratio, 1.0, 1e-15);
  // s = log 2, t(0.975, 2) = 4.30265, half = t s / sqrt(3)
  const double half = 4.302652729749463 * std::log(2.0) / std::sqrt(3.0);
  EXPECT_NEAR(r.low, std::exp(-half), 1e-10 * std::exp(-half));
  EXPECT_NEAR(r.high, std::exp(half), 1e-10 * std::exp(half));
  EXPECT_EQ(r.second_smaller, 1U);
  EXPECT_EQ(r.first_smaller, 1U);
  EXPECT_EQ(r.sign_test, 1.0);
}

TEST(PairedRatio, ScalesAndInverts) {
  const std::vector<double> first{0.3, 1.7, 2.9, 0.8, 1.1};
  const std::vector<double> second{0.2, 1.9, 2.0, 0.7, 0.9};
  std::vector<double> scaled = second;
  for (double& x : scaled) x *= 3.0;
  const PairedRatio r = paired_ratio(first, second);
  const PairedRatio inverse = paired_ratio(second, first);
  const PairedRatio times = paired_ratio(first, scaled);
  EXPECT_NEAR(r.ratio * inverse.ratio, 1.0, 1e-14);
  EXPECT_NEAR(r.low * inverse.high, 1.0, 1e-14);
  EXPECT_NEAR(times.ratio, 3.0 * r.ratio, 1e-14 * times.ratio);
  EXPECT_NEAR(times.high, 3.0 * r.high, 1e-14 * times.high);
  EXPECT_EQ(r.second_smaller, 4U);
}

TEST(PairedRatio, LeavesOutWhatHasNoRatio) {
  EXPECT_EQ(paired_ratio(std::vector{0.0, 2.0}, std::vector{1.0, 1.0}).pairs, 1U);
  const PairedRatio one = paired_ratio(std::vector{2.0}, std::vector{1.0});
  EXPECT_EQ(one.ratio, 0.5);
  EXPECT_EQ(one.low, one.high);
  EXPECT_EQ(paired_ratio({}, {}).pairs, 0U);
  EXPECT_THROW(static_cast<void>(paired_ratio(std::vector{1.0}, {})), std::invalid_argument);
}

TEST(OverlappingRatio, IsThePlainOneOfStretchesApart) {
  const std::vector<double> first{0.3, 1.7, 2.9, 0.8, 1.1};
  const std::vector<double> second{0.2, 1.9, 2.0, 0.7, 0.9};
  const PairedRatio plain = paired_ratio(first, second);
  for (const double spacing : {10.0, 11.0, 1e9}) {
    const std::vector<double> times{3.0 * spacing, 0.0, spacing, 7.0 * spacing, 2.0 * spacing};
    const PairedRatio r = paired_ratio(first, second, times, 10.0);
    EXPECT_EQ(r.ratio, plain.ratio) << spacing;
    EXPECT_EQ(r.low, plain.low) << spacing;
    EXPECT_EQ(r.high, plain.high) << spacing;
    EXPECT_EQ(r.sign_test, plain.sign_test) << spacing;
  }
}

TEST(OverlappingRatio, ByHand) {
  const std::vector<double> first{1.0, 2.0, 4.0};
  const std::vector<double> second{2.0, 2.0, 2.0};  // logarithms: log 2, 0, -log 2
  // Neighbours share half: k = 9 / (3 + 4 / 2) = 1.8 stretches, one degree of freedom, t(0.975, 1) = tan(0.475 pi).
  const PairedRatio r = paired_ratio(first, second, std::vector{0.0, 5.0, 10.0}, 10.0);
  const double half = std::tan(0.475 * M_PI) * std::log(2.0) * std::sqrt(2.0 / 3.0 / 0.8);
  EXPECT_NEAR(r.ratio, 1.0, 1e-15);
  EXPECT_NEAR(std::log(r.low), -half, 1e-10 * half);
  EXPECT_NEAR(std::log(r.high), half, 1e-10 * half);
}

TEST(OverlappingRatio, OfTooFewStretches) {
  const std::vector<double> errors{2.0, 3.0};
  const std::vector<double> ones{1.0, 1.0};
  const PairedRatio together = paired_ratio(errors, ones, std::vector{7.0, 7.0}, 10.0);  // one stretch, twice
  EXPECT_EQ(together.pairs, 2U);
  EXPECT_EQ(together.low, together.ratio);
  EXPECT_EQ(together.high, together.ratio);
  // One stretch and a little says next to nothing, and says so.
  const PairedRatio little = paired_ratio(errors, ones, std::vector{7.0, 7.5}, 10.0);
  EXPECT_LT(little.low, 0.01 * little.ratio);
  EXPECT_GT(little.high, 100.0 * little.ratio);
  const PairedRatio one = paired_ratio(std::vector{2.0}, std::vector{1.0}, std::vector{7.0}, 10.0);
  EXPECT_EQ(one.low, 0.5);
  EXPECT_EQ(one.high, 0.5);
  EXPECT_EQ(paired_ratio({}, {}, {}, 10.0).pairs, 0U);
  EXPECT_THROW(static_cast<void>(paired_ratio(errors, ones, std::vector{1.0}, 10.0)), std::invalid_argument);
}

/// How often 95 % intervals hold the truth: logarithms of ratios are moving sums of white noise over 10 steps, one each
/// `every` steps.
struct Coverage {
  double overlapping = 0.0;
  double plain = 0.0;
};
Coverage coverage_of_moving_sums(std::size_t pairs, std::size_t every, int draws) {
  constexpr std::size_t kLength = 10;
  constexpr double kTruth = 0.3;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0.0, 0.1);
  Coverage share;
  const auto holds = [](const PairedRatio& r) { return std::log(r.low) <= kTruth && kTruth <= std::log(r.high); };
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<double> noise(every * (pairs - 1) + kLength);
    for (double& e : noise) e = normal(random);
    std::vector<double> second, times;
    for (std::size_t i = 0; i < pairs; ++i) {
      double sum = kTruth;
      for (std::size_t j = 0; j < kLength; ++j) sum += noise[every * i + j];
      second.push_back(std::exp(sum));
      times.push_back(static_cast<double>(every * i));
    }
    const std::vector<double> first(pairs, 1.0);
    share.overlapping += holds(paired_ratio(first, second, times, kLength)) ? 1.0 / draws : 0.0;
    share.plain += holds(paired_ratio(first, second)) ? 1.0 / draws : 0.0;
  }
  return share;
}

TEST(OverlappingRatio, IntervalHoldsTheTruthAsOftenAsItSays) {
  constexpr int kDraws = 4000;
  const double bound = 3.29 * std::sqrt(0.95 * 0.05 / kDraws);  // binomial, 99.9 %
  const Coverage half = coverage_of_moving_sums(40, 5, kDraws);
  EXPECT_NEAR(half.overlapping, 0.95, bound);
  // The mean is worth k = 40^2 / (40 + 2 39 / 2) = 20.25 pairs, and s / sqrt(40) is 0.69 of its deviation: erf(0.69 2.02 /
  // sqrt(2)).
  EXPECT_NEAR(half.plain, 0.84, 0.03);
  // Degrees of freedom are counted low: with few stretches the interval errs on the wide side.
  EXPECT_GE(coverage_of_moving_sums(10, 5, kDraws).overlapping, 0.95 - bound);
  EXPECT_GE(coverage_of_moving_sums(30, 1, kDraws).overlapping, 0.95 - bound);
  EXPECT_GE(coverage_of_moving_sums(4, 5, kDraws).overlapping, 0.95 - bound);
  EXPECT_LE(coverage_of_moving_sums(30, 1, kDraws).plain, 0.5);
}

TEST(Quantile, BetweenOrderStatistics) {
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  EXPECT_NEAR(quantile({0.0, 10.0}, 0.95), 9.5, 1e-14);
}

}  // namespace
}  // namespace coast::study
