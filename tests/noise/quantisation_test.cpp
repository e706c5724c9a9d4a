// What is rounded follows from the unit; the closed forms are those of independent rounding errors.

#include <gtest/gtest.h>

#include <cmath>

#include "coast/record/error.hpp"
#include "noise/entries.hpp"

namespace coast {
namespace {

using noise::Rounding;
using noise::Sensor;
using test::process_of;

TEST(Quantisation, UnitSaysWhatIsRounded) {
  const auto of = [](const char* unit, Sensor sensor) {
    return process_of(std::string("{process: quantisation, step: 2, unit: ") + unit + "}", sensor, 100.0)->rounding();
  };
  for (const char* unit : {"rad", "mrad", "deg", "mdeg", "arcsec"})
    EXPECT_EQ(of(unit, Sensor::kGyro)->of, Rounding::Of::kIntegral) << unit;
  for (const char* unit : {"rad/s", "deg/s", "dps", "deg/h"})
    EXPECT_EQ(of(unit, Sensor::kGyro)->of, Rounding::Of::kSample) << unit;
  EXPECT_EQ(of("m/s", Sensor::kAccel)->of, Rounding::Of::kIntegral);
  for (const char* unit : {"m/s^2", "g", "mg", "ug"}) EXPECT_EQ(of(unit, Sensor::kAccel)->of, Rounding::Of::kSample) << unit;
  EXPECT_NEAR(of("arcsec", Sensor::kGyro)->step, 2.0 * M_PI / 180.0 / 3600.0, 1e-20);
  EXPECT_NEAR(of("mg", Sensor::kAccel)->step, 2.0 * 9.80665e-3, 1e-17);
}

// IEEE 952: 3 Q^2/tau^2, read at sqrt(3) s; Hadamard by the sum of squares of 1, -3, 3, -1. A rounded integral adds nothing to
// the filter's white noise.
TEST(Quantisation, OfTheIntegralFallsWithTheSquareOfTime) {
  const auto process = process_of("{process: quantisation, step: 1e-5, unit: rad}", Sensor::kGyro);
  const double Q = 1e-5 / std::sqrt(12.0);
  EXPECT_NEAR(std::sqrt(*process->allan_variance(std::sqrt(3.0))), Q, 1e-14 * Q);
  EXPECT_NEAR(*process->hadamard_variance(10.0), 20.0 * Q * Q / 600.0, 1e-14 * Q * Q);
  EXPECT_EQ(process->white_density().value, 0.0);
  EXPECT_EQ(process->states(), 0);
}

// 12 bits over +-300 deg/s at 100 Hz: 0.146 deg/s a step, 0.0423 deg/s rms a sample, 0.00423 deg/s/sqrt(Hz).
TEST(Quantisation, OfSamplesIsWhite) {
  const auto process = process_of("{process: quantisation, step: 0.146484375, unit: deg/s}", Sensor::kGyro, 100.0);
  const double density = 0.146484375 / std::sqrt(12.0) / 10.0 * M_PI / 180.0;
  EXPECT_NEAR(std::sqrt(process->white_density().value), density, 1e-14 * density);
  EXPECT_NEAR(*process->allan_variance(4.0), density * density / 4.0, 1e-14 * density * density);
  EXPECT_NEAR(*process->hadamard_variance(4.0), density * density / 4.0, 1e-14 * density * density);
}

TEST(Quantisation, NeedsAStepAndForSamplesARate) {
  EXPECT_THROW((void)process_of("{process: quantisation, step: 1, unit: deg/s}", Sensor::kGyro), InputError);
  EXPECT_THROW((void)process_of("{process: quantisation, step: 0, unit: arcsec}", Sensor::kGyro), InputError);
  try {
    (void)process_of("{process: quantisation, step: 1, unit: m/s}", Sensor::kGyro);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("arcsec"), std::string::npos) << e.what();
  }
}

TEST(Quantisation, StaysItselfWhereWhiteNoiseIsNotScaled) {
  const auto model = test::model_of(R"(schema: coast.imu_error_model/1
rate_hz: 100
gyro: {all: [{process: quantisation, step: 0.1, unit: deg/s}, {process: quantisation, step: 1, unit: arcsec}]}
accel: {all: []}
)");
  const auto same = model.with_white_noise_scaled(Sensor::kGyro, Eigen::Vector3d::Constant(1.0));
  EXPECT_EQ(same.yaml(), model.yaml());
  const auto scaled = model.with_white_noise_scaled(Sensor::kGyro, Eigen::Vector3d::Constant(3.0));
  const double before = model.white_density(Sensor::kGyro, 0).value;
  EXPECT_NEAR(scaled.white_density(Sensor::kGyro, 0).value, 9.0 * before, 1e-14 * 9.0 * before);
  EXPECT_EQ(scaled.axes(Sensor::kGyro)[0][0]->rounding(), std::nullopt);
  EXPECT_TRUE(scaled.axes(Sensor::kGyro)[0][1]->rounding().has_value());
}

}  // namespace
}  // namespace coast
