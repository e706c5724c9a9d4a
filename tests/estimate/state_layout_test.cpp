#include "coast/estimate/state_layout.hpp"

#include <gtest/gtest.h>

#include "estimate/mission.hpp"

namespace coast {
namespace {

// Density of an AR(1) at frequency zero: (sigma / (1 - a))^2 dt.
TEST(StateLayout, TakesWhatForgetsFastForWhiteNoise) {
  const estimate::StateLayout layout(test::error_model(R"(schema: coast.imu_error_model/1
gyro:
  x: [{process: ar, coefficients: [0.3], innovation_sigma: 0.01, unit: rad/s, rate_hz: 100}]
  y: []
  z: [{process: ar, coefficients: [0.9999], innovation_sigma: 1e-5, unit: rad/s, rate_hz: 100}]
accel: {all: []}
)"),
                                     Eigen::Matrix3d::Identity(), {});
  ASSERT_EQ(layout.sensors().size(), 1U);
  EXPECT_EQ(layout.sensors()[0].name, "gyro_z ar");
  EXPECT_NEAR(layout.gyro_noise_b()(0, 0), 0.01 / 0.7 / 10.0, 1e-15);
  EXPECT_EQ(layout.gyro_noise_b()(2, 2), 0.0);
}

}  // namespace
}  // namespace coast
