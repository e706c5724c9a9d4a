// Statistics of the largest of many hypotheses.

#include "coast/diagnose/examination.hpp"

#include <gtest/gtest.h>

#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"

namespace coast {
namespace {

using namespace diagnose;

// The largest of n independent squares: 1 - (1 - p)^n, p from the table of chi-square(1): P(X > 3.841) = 0.05.
TEST(LargestByChance, IsThatOfIndependentSquares) {
  const LargestByChance one{1.0};
  EXPECT_NEAR(one.p_value(3.8415), 0.05, 1e-4);
  const LargestByChance ten{10.0};
  EXPECT_NEAR(ten.p_value(3.8415), 1.0 - std::pow(0.95, 10.0), 1e-4);
  EXPECT_NEAR(ten.p_value(ten.quantile(0.05)), 0.05, 1e-12);
  EXPECT_NEAR(LargestByChance{57.0}.quantile(0.05), noise::chi2_upper_quantile(1.0, 1.0 - std::pow(0.95, 1.0 / 57.0)), 1e-9);
}

// The integral of Cauchy prior times likelihood, by the trapezoid rule over the angle: c = plausible tan(angle). The tolerance
// is the mixture's, 40 normal priors.
TEST(LogBayesFactor, IsTheIntegralOverACauchyPrior) {
  for (const double plausible : {0.1, 1.0, 30.0})
    for (const double sigmas : {0.0, 2.0, 8.0, 40.0})
      for (const double information : {0.04, 1.0, 25.0}) {
        constexpr int kSteps = 1'000'000;
        const double score = sigmas * std::sqrt(information);
        const double largest = 0.5 * score * score / information;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
          const double c = plausible * std::tan(geo::kPi * ((i + 0.5) / kSteps - 0.5));
          sum += std::exp(score * c - 0.5 * information * c * c - largest);
        }
        EXPECT_NEAR(log_bayes_factor(score, information, plausible), largest + std::log(sum / kSteps), 0.05)
            << plausible << " " << score << " " << information;
      }
}

// Geodesy: noncentrality 17.07 at alpha = 0.1 % and power 80 % (Baarda 1968).
TEST(MinimalDetectable, IsBaardas) {
  EXPECT_NEAR(minimal_detectable(1.0, noise::chi2_upper_quantile(1.0, 0.001)), std::sqrt(17.07), 2e-3);
  EXPECT_NEAR(minimal_detectable(3.0, 10.8), 3.0 * minimal_detectable(1.0, 10.8), 1e-12);
}

}  // namespace
}  // namespace coast
