#include "coast/tumble/cover.hpp"

#include <gtest/gtest.h>

#include "tumbled.hpp"

namespace coast::tumble {
namespace {

TEST(Cover, AsksForTheSideThatIsMissing) {
  test::Tumble plan;
  const auto [accel, gyro] = test::drawn_errors(4);
  const test::Tumbled made = test::tumbled(plan, accel, gyro);
  Options options;
  options.gravity = plan.gravity;
  Result result = calibrate(made.sensor, options);
  // A pose in a direction that is known tells less than one in a direction of large uncertainty.
  Eigen::Matrix<double, 9, 9>& P = result.accel_covariance;
  P = 1e-8 * Eigen::Matrix<double, 9, 9>::Identity();
  P(2, 2) = 1e-2;  // bias z
  const std::vector<Proposal> next = proposals(result, 2);
  ASSERT_EQ(next.size(), 2U);
  EXPECT_GT(std::abs(next[0].up.z()), 0.99);
  EXPECT_GT(next[0].information, next[1].information);
  EXPECT_NEAR(information(result, next[0].up), next[0].information, 1e-12);
}

}  // namespace
}  // namespace coast::tumble
