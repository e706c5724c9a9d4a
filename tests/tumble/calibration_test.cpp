#include "coast/tumble/calibration.hpp"

#include <gtest/gtest.h>

#include "coast/record/error.hpp"
#include "tumbled.hpp"

namespace coast::tumble {
namespace {

using record::ImuCalibration;
using test::drawn_errors;
using test::Tumble;
using test::tumbled;
using test::Tumbled;

Options place_of(const Tumble& plan) {
  Options options;
  options.gravity = plan.gravity;
  options.gravity_sd = 1e-6;
  return options;
}

// The 24 values in the order of the covariance.
Eigen::Matrix<double, 24, 1> values_of(const record::TriadErrors& accel, const record::TriadErrors& gyro) {
  Eigen::Matrix<double, 24, 1> v;
  const auto put = [&v](int at, const record::TriadErrors& triad) {
    v.segment<3>(at) = triad.bias;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) v[at + 3 + 3 * i + j] = triad.gain(i, j);
  };
  put(ImuCalibration::kAccel, accel);
  put(ImuCalibration::kGyro, gyro);
  return v;
}

TEST(TumbleCalibration, FindsTheErrorsWithoutNoise) {
  Tumble plan;
  plan.gyro_noise = plan.accel_noise = plan.gyro_walk = plan.accel_wander = 0.0;
  plan.gyro_noise = 1e-9;  // rests are told by their noise
  plan.accel_noise = 1e-9;
  const auto [accel, gyro] = drawn_errors(3);
  const Tumbled made = tumbled(plan, accel, gyro);
  Options options = place_of(plan);
  options.latitude = plan.latitude;
  const Result result = calibrate(made.sensor, options);
  const Eigen::Matrix<double, 24, 1> found = values_of(result.calibration.accel, result.calibration.gyro);
  const Eigen::Matrix<double, 24, 1> truth = values_of(accel, gyro);
  // What is left is the integration of turns at 100 Hz by two-sample coning.
  for (int i = 0; i < 24; ++i) EXPECT_NEAR(found[i], truth[i], 2e-5) << i;
}

TEST(TumbleCalibration, NinetyFivePercentMeansNinetyFive) {
  int inside = 0, all = 0;
  Eigen::Array<double, 24, 1> squares = Eigen::Array<double, 24, 1>::Zero();
  constexpr std::uint64_t kRuns = 60;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    Tumble plan;
    plan.seed = 100 + run;
    auto [accel, gyro] = drawn_errors(500 + run);
    const Tumbled made = tumbled(plan, accel, gyro);
    const Result result = calibrate(made.sensor, place_of(plan));
    gyro.bias = made.mean_gyro_bias;
    const Eigen::Matrix<double, 24, 1> error =
        values_of(result.calibration.accel, result.calibration.gyro) - values_of(accel, gyro);
    for (int i = 0; i < 24; ++i) {
      const double z = error[i] / std::sqrt(result.calibration.covariance(i, i));
      squares[i] += z * z / static_cast<double>(kRuns);
      ++all;
      if (std::abs(z) < 1.96) ++inside;
    }
  }
  // A mean of 60 squares of chi-square 1: 1 +- 0.18.
  EXPECT_LT(squares.maxCoeff(), 1.0 + 4.0 * 0.18);
  EXPECT_GT(squares.minCoeff(), 1.0 - 4.0 * 0.18);
  // 60 x 24 intervals, some of them of values that are correlated: as 60 x 12 independent ones the share has a standard
  // deviation of 0.8 %.
  EXPECT_NEAR(static_cast<double>(inside) / all, 0.95, 0.03);
}

// A pose that gives way under the IMU, and a turn beyond the gyros' range, are left out; the values stay.
TEST(TumbleCalibration, LeavesOutWhatContradictsTheRest) {
  const Tumble plan;
  const auto [accel, gyro] = drawn_errors(7);
  Tumbled made = tumbled(plan, accel, gyro);
  const auto change = [&made](double from, double to, auto what) {
    for (record::ImuSample& sample : made.sensor.samples) {
      const double t = sample.t - made.sensor.samples.front().t;
      if (t > from && t < to) what(sample);
    }
  };
  change(made.rests[6].first, made.rests[6].second, [](record::ImuSample& s) { s.dv *= 1.02; });
  change(made.rests[12].second, made.rests[13].first,
         [](record::ImuSample& s) { s.dtheta = s.dtheta.cwiseMax(-0.008).cwiseMin(0.008).eval(); });
  const Result result = calibrate(made.sensor, place_of(plan));
  EXPECT_FALSE(result.rests[6].used);
  EXPECT_FALSE(result.turns[12].used);
  const Eigen::Matrix<double, 24, 1> error =
      values_of(result.calibration.accel, result.calibration.gyro) - values_of(accel, gyro);
  for (int i = 0; i < 24; ++i)
    if (i < ImuCalibration::kGyro || i > ImuCalibration::kGyro + 2) {
      EXPECT_LT(std::abs(error[i]), 4.0 * std::sqrt(result.calibration.covariance(i, i))) << i;
    }
}

// Tactical gyros: the Earth's rate tells the heading, and with it is not taken for a bias.
TEST(TumbleCalibration, SeesTheEarthsRateWhereTheGyrosAreGoodEnough) {
  Tumble plan;
  plan.gyro_noise = 1e-6;
  plan.gyro_walk = 1e-9;
  plan.rest_s = 20.0;
  const auto [accel, gyro] = drawn_errors(9, 0.001);
  const Tumbled made = tumbled(plan, accel, gyro);
  Options options = place_of(plan);
  options.latitude = plan.latitude;
  const Result result = calibrate(made.sensor, options);
  ASSERT_TRUE(result.heading_sd.has_value());
  EXPECT_LT(*result.heading_sd, 0.1);
  for (int i = 0; i < 3; ++i) {
    const double sd = result.calibration.bias_sd(ImuCalibration::kGyro, i);
    EXPECT_LT(sd, 5e-6);  // a fourteenth of the Earth's rate
    EXPECT_NEAR(result.calibration.gyro.bias[i], made.mean_gyro_bias[i], 4.0 * sd) << i;
  }
}

TEST(TumbleCalibration, NamesTheAxesAndTheUnitThatWouldAgree) {
  const Tumble plan;
  const auto [accel, gyro] = drawn_errors(5);
  Tumbled made = tumbled(plan, accel, gyro);
  for (record::ImuSample& s : made.sensor.samples)
    s.dtheta = 180.0 / std::numbers::pi * Eigen::Vector3d(-s.dtheta.y(), s.dtheta.x(), s.dtheta.z());
  try {
    static_cast<void>(calibrate(made.sensor, place_of(plan)));
    FAIL() << "nothing is said";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("[y, -x, z]"), std::string::npos) << text;
    EXPECT_NE(text.find("times 0.01745"), std::string::npos) << text;
  }
}

TEST(TumbleCalibration, RefusesWhatTellsTooLittle) {
  Tumble plan;
  plan.poses = 4;
  const auto [accel, gyro] = drawn_errors(6);
  EXPECT_THROW(static_cast<void>(calibrate(tumbled(plan, accel, gyro).sensor, place_of(plan))), InputError);
  plan.poses = 25;
  Tumbled still = tumbled(plan, accel, gyro);
  still.sensor.samples.resize(300);
  EXPECT_THROW(static_cast<void>(calibrate(still.sensor, place_of(plan))), InputError);
  still.sensor.samples.resize(20);
  EXPECT_THROW(static_cast<void>(find_rests(still.sensor)), InputError);
}

}  // namespace
}  // namespace coast::tumble
