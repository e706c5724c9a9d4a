#include "coast/study/paired.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Quantile, BetweenOrderStatistics) {
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  EXPECT_NEAR(quantile({0.0, 10.0}, 0.95), 9.5, 1e-14);
}

}  // namespace
}  // namespace coast::study
