#include "coast/noise/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coast {
namespace {

// Abramowitz & Stegun (1964), table 26.8: upper quantiles, all digits of the table (five and six significant).
struct Quantile {
  int dof;
  double p;
  double x;
};

TEST(ChiSquare, PublishedQuantiles) {
  for (const Quantile& q : {Quantile{1, 0.05, 3.84146}, Quantile{2, 0.05, 5.99147}, Quantile{3, 0.05, 7.81473},
                            Quantile{3, 0.001, 16.2662}, Quantile{4, 0.01, 13.2767}, Quantile{5, 0.05, 11.0705},
                            Quantile{7, 0.95, 2.16735}, Quantile{10, 0.005, 25.1882}, Quantile{30, 0.5, 29.3360}}) {
    EXPECT_NEAR(noise::chi2_upper_quantile(q.dof, q.p), q.x, 6e-6 * q.x) << q.dof << " " << q.p;
    EXPECT_NEAR(noise::chi2_survival(q.dof, noise::chi2_upper_quantile(q.dof, q.p)), q.p, 1e-12);
  }
}

// The survival function is the integral of the density: Simpson's rule, 1e5 panels, error below 1e-13.
TEST(ChiSquare, SurvivalIsTheIntegralOfTheDensity) {
  for (int dof = 2; dof <= 9; ++dof) {
    const double half = 0.5 * dof;
    const auto density = [&](double x) {
      return std::exp((half - 1.0) * std::log(0.5 * x) - 0.5 * x - std::lgamma(half)) / 2.0;
    };
    const double from = 3.0, to = 9.0;
    const int n = 20000;
    double sum = density(from) + density(to);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * density(from + (to - from) * i / n);
    const double integral = sum * (to - from) / n / 3.0;
    EXPECT_NEAR(noise::chi2_survival(dof, from) - noise::chi2_survival(dof, to), integral, 1e-13) << dof;
  }
  EXPECT_EQ(noise::chi2_survival(3, 0.0), 1.0);
  EXPECT_NEAR(noise::chi2_survival(1, 1.0), std::erfc(std::sqrt(0.5)), 1e-15);
}

// With two degrees of freedom the survival is exp(-x/2), with four (1 + x/2) exp(-x/2): Abramowitz & Stegun eq. 26.4.4.
TEST(ChiSquare, LogSurvivalGoesOnWhereSurvivalUnderflows) {
  for (const double x : {0.1, 1.0, 10.0, 100.0, 5e3, 1e6}) {
    EXPECT_NEAR(noise::chi2_log_survival(2, x), -0.5 * x, 1e-12 * (1.0 + x)) << x;
    EXPECT_NEAR(noise::chi2_log_survival(4, x), std::log1p(0.5 * x) - 0.5 * x, 1e-12 * (1.0 + x)) << x;
  }
}

// Degrees of freedom that are not whole: the density's integral again; chi2(2 a) is monotone in between.
TEST(ChiSquare, AnyDegreesOfFreedom) {
  for (const double dof : {2.7, 5.5, 146.177, 801.25}) {
    const double half = 0.5 * dof;
    const auto density = [&](double x) {
      return std::exp((half - 1.0) * std::log(0.5 * x) - 0.5 * x - std::lgamma(half)) / 2.0;
    };
    const double from = 0.8 * dof, to = 1.3 * dof;
    const int n = 20000;
    double sum = density(from) + density(to);
    for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * density(from + (to - from) * i / n);
    EXPECT_NEAR(noise::chi2_survival(dof, from) - noise::chi2_survival(dof, to), sum * (to - from) / n / 3.0, 1e-12) << dof;
  }
}

// Where the cube root takes over, at dof 1000, its quantiles agree with the exact ones to 2e-6 of the quantile.
TEST(ChiSquare, ManyDegreesOfFreedom) {
  for (const double p : {0.975, 0.84, 0.5, 0.16, 0.025})
    EXPECT_NEAR(noise::chi2_upper_quantile(1000.0 + 1e-9, p), noise::chi2_upper_quantile(1000.0, p), 2e-6 * 1000.0) << p;
}

}  // namespace
}  // namespace coast
