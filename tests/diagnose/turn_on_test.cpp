// Constants of a sensor that are larger than its error model has them: a bias, or an effect that is one during the mission.

#include <gtest/gtest.h>

#include "coast/diagnose/diagnosis.hpp"
#include "diagnose/concealed.hpp"

namespace coast {
namespace {

using namespace diagnose;

using test::kWithoutTwins;
using test::names;
using test::only;

TEST(TurnOn, ABiasBeyondTheErrorModelIsToldAndModelled) {
  constexpr double kBias = 3e-3;  // rad/s: thirty sigma
  MissionInput input = test::honest_mission(21);
  const double stated = input.setup.model.bias_sd(noise::Sensor::kGyro, 2);
  for (record::ImuSample& sample : input.imu.samples) sample.dtheta.z() += kBias * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  EXPECT_TRUE(d.findings.empty()) << names(d);
  ASSERT_EQ(d.noise.size(), 1U) << names(d);
  const NoiseFinding& f = d.noise.front();
  EXPECT_EQ(f.name + " " + f.sensor + " " + f.axis, "turn_on_bias gyro z");
  EXPECT_NEAR(f.value, kBias, 4.0 * stated);  // beside what the simulation drew
  EXPECT_LT(f.sd, 0.1 * stated);
  // N(b; 0, b^2) over N(b; 0, s^2)
  const double ratio = f.value / stated;
  EXPECT_NEAR(f.delta_log_likelihood, 0.5 * ratio * ratio - 0.5 - std::log(ratio), 1e-6);
  EXPECT_GT(d.after.log_likelihood_per_epoch, d.before.log_likelihood_per_epoch);
  EXPECT_NEAR(d.modelled.setup.model.bias_sd(noise::Sensor::kGyro, 2), std::hypot(f.value, stated), 1e-9);
}

// Of 10 mrad/s that the force along z makes, a hundred sigma of the bias, nearly all is gravity's; bumps make the rest.
TEST(TurnOn, AConstantThatFollowsTheForceIsNotABias) {
  constexpr double kCoefficient = 1e-3;
  MissionInput input = test::honest_mission(24);
  for (record::ImuSample& sample : input.imu.samples) sample.dtheta.x() += kCoefficient * sample.dv.z();
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "gyro_g_sensitivity", "xz");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, kCoefficient, 4.0 * f->sd);
  EXPECT_TRUE(d.noise.empty()) << names(d);
}

// As large as the mission needs it to be seen at all: of what is plausible of a tactical gyro it shows nothing.
TEST(Diagnosis, WhatIsImplausibleIsFoundWhereNothingElseExplainsIt) {
  constexpr double kCoefficient = 1e-3;
  MissionInput input = test::honest_mission(23);
  input.setup.model = input.setup.model.with_white_noise_scaled(noise::Sensor::kGyro, Eigen::Vector3d::Constant(0.75));
  for (record::ImuSample& sample : input.imu.samples) sample.dtheta.z() += kCoefficient * sample.dv.x();
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "gyro_g_sensitivity", "zx");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, kCoefficient, 4.0 * f->sd);
}

}  // namespace
}  // namespace coast
