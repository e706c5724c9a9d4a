#include "turn.hpp"

#include <gtest/gtest.h>

#include "coast/geo/rotation.hpp"
#include "tumbled.hpp"

namespace coast::tumble {
namespace {

// Partial derivatives against differences of the integration itself.
TEST(Turn, PartialDerivativesAreThoseOfTheRotation) {
  test::Tumble plan;
  plan.poses = 2;
  const auto [accel, gyro] = test::drawn_errors(2);
  const test::Tumbled made = test::tumbled(plan, accel, gyro);
  const Eigen::Vector3d earth(3e-5, -4e-5, 5e-5);
  const GyroErrors at{gyro.gain, Eigen::Vector3d(0.01, -0.02, 0.005), Eigen::Vector3d(0.012, -0.021, 0.004)};
  const auto turn = [&](const GyroErrors& errors) { return integrate(made.sensor, 500, 799, errors, earth); };
  const Turn base = turn(at);
  EXPECT_NEAR(base.duration, 3.0, 1e-9);
  EXPECT_GT(base.turned, 0.5);
  const auto difference = [&](auto change) {
    constexpr double kStep = 1e-6;
    GyroErrors up = at, down = at;
    change(up, kStep);
    change(down, -kStep);
    return Eigen::Vector3d(geo::rotation_vector(Eigen::Quaterniond(Eigen::Matrix3d(turn(up).C * turn(down).C.transpose()))) /
                           (2.0 * kStep));
  };
  // The derivatives take the rate as constant within a sample: relative error of the order of the rotation of one, 0.03 rad.
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const Eigen::Vector3d d = difference([&](GyroErrors& e, double h) { e.gain(row, column) += h; });
      EXPECT_LT((d - base.by_gain.col(3 * row + column)).norm(), 0.01 * base.turned) << row << column;
    }
    const Eigen::Vector3d before = difference([&](GyroErrors& e, double h) { e.bias_before[row] += h; });
    EXPECT_LT((before - base.by_bias_before.col(row)).norm(), 0.01 * base.duration);
    const Eigen::Vector3d after = difference([&](GyroErrors& e, double h) { e.bias_after[row] += h; });
    EXPECT_LT((after - base.by_bias_after.col(row)).norm(), 0.01 * base.duration);
  }
}

}  // namespace
}  // namespace coast::tumble
