// Statistics of the largest of many hypotheses.

#include "coast/diagnose/examination.hpp"

#include <gtest/gtest.h>

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

// Geodesy: noncentrality 17.07 at alpha = 0.1 % and power 80 % (Baarda 1968).
TEST(MinimalDetectable, IsBaardas) {
  EXPECT_NEAR(minimal_detectable(1.0, noise::chi2_upper_quantile(1.0, 0.001)), std::sqrt(17.07), 2e-3);
  EXPECT_NEAR(minimal_detectable(3.0, 10.8), 3.0 * minimal_detectable(1.0, 10.8), 1e-12);
}

}  // namespace
}  // namespace coast
