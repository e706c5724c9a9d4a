// Forward and backward pass of one epoch.

#include <gtest/gtest.h>

#include "pass.hpp"

namespace coast::carrier {
namespace {

using record::FixQuality;

PpkEpoch solved(FixQuality quality, double x, double sd) {
  PpkEpoch epoch;
  epoch.quality = quality;
  epoch.r_e = Eigen::Vector3d(6378137.0 + x, 0.0, 0.0);
  epoch.covariance_e = sd * sd * Eigen::Matrix3d::Identity();
  return epoch;
}

PpkEpoch combined(const PpkEpoch& forward, const PpkEpoch& backward) {
  return combine(std::vector{forward}, std::vector{backward}).front();
}

TEST(Combination, WeighsFloatsByTheirInformation) {
  const PpkEpoch both = combined(solved(FixQuality::kFloat, 0.0, 0.1), solved(FixQuality::kFloat, 0.3, 0.2));
  EXPECT_EQ(both.quality, FixQuality::kFloat);
  EXPECT_NEAR(both.r_e.x() - 6378137.0, 0.3 * 0.01 / 0.05, 1e-9);  // weights 100 and 25
  EXPECT_NEAR(both.covariance_e(0, 0), 1.0 / 125.0, 1e-12);
}

TEST(Combination, AFixThatAFloatContradictsIsInDoubt) {
  const PpkEpoch both = combined(solved(FixQuality::kFixed, 0.0, 0.01), solved(FixQuality::kFloat, 3.0, 0.2));
  EXPECT_EQ(both.quality, FixQuality::kFloat);
  EXPECT_EQ(both.shortfall, Shortfall::kSeparated);
  EXPECT_GT(std::sqrt(both.covariance_e(0, 0)), 2.9);  // covers both
}

TEST(Combination, IntegersKnownFromTheWholeArcAreNotDoubtedByAFloat) {
  PpkEpoch forward = solved(FixQuality::kFixed, 0.0, 0.01);
  forward.fixed_ambiguities = forward.known_ambiguities = 12;
  forward.ratio = 100.0;
  const PpkEpoch both = combined(forward, solved(FixQuality::kFloat, 3.0, 0.2));
  EXPECT_EQ(both.quality, FixQuality::kFixed);
  EXPECT_EQ(both.r_e, forward.r_e);
  EXPECT_NEAR(std::sqrt(both.covariance_e(0, 0)), 0.01, 1e-12);
  // Two fixes that contradict each other are both in doubt.
  EXPECT_EQ(combined(forward, solved(FixQuality::kFixed, 3.0, 0.01)).quality, FixQuality::kFloat);
}

}  // namespace
}  // namespace coast::carrier
