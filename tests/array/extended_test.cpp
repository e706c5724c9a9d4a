// The parts of the extended mechanisation: weights, shares, the sum with its biases, block means.

#include "coast/array/extended.hpp"

#include <gtest/gtest.h>

#include <random>

#include "coast/array/channel.hpp"
#include "coast/array/synthetic.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "support/support.hpp"

namespace coast::array {
namespace {

noise::ImuErrorModel model_of(const std::string& gyro, const std::string& accel) {
  return noise::ImuErrorModel::from(
      io::parse_yaml("schema: coast.imu_error_model/1\ngyro: {" + gyro + "}\naccel: {" + accel + "}\n", "model.yaml"));
}

const std::string kForceNoise = "all: [{process: white_noise, density: 1, unit: m/s^2/sqrt(Hz)}]";

TEST(Extended, WeightsGoByTheWhiteNoiseOfTheAxisThatLiesAlongTheBodys) {
  const auto even = model_of("all: [{process: white_noise, density: 1, unit: deg/s/sqrt(Hz)}]", kForceNoise);
  const auto uneven = model_of(
      "x: [{process: white_noise, density: 2, unit: deg/s/sqrt(Hz)}], y: [{process: white_noise, density: 1, unit: "
      "deg/s/sqrt(Hz)}], z: [{process: white_noise, density: 0.5, unit: deg/s/sqrt(Hz)}]",
      kForceNoise);
  Eigen::Matrix3d C_s_b;  // body x = sensor y, body y = -sensor x
  C_s_b << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  const std::vector<ModelledSensor> sensors{{"even", &even}, {"uneven", &uneven, C_s_b}};
  const Eigen::MatrixXd weights = extended_weights(sensors);
  EXPECT_NEAR(weights(0, 1), 0.5, 1e-12);  // sensor y: 1 against 1
  EXPECT_NEAR(weights(1, 1), 0.2, 1e-12);  // sensor x: 1/4 against 1
  EXPECT_NEAR(weights(2, 1), 0.8, 1e-12);  // sensor z: 4 against 1
  EXPECT_NEAR(weights(5, 0), 0.5, 1e-12);
  // The density of a sum with such weights is one over the sum of the inverses.
  const noise::ImuErrorModel sum = extended_error_model("sum", 100.0, sensors);
  EXPECT_NEAR(sum.white_density(noise::Sensor::kGyro, 2).value, geo::kDegree * geo::kDegree / 5.0, 1e-15);
  EXPECT_EQ(sum.members(), (std::vector<std::string>{"even", "uneven"}));
}

TEST(Extended, AnAxisThatPointsTheOtherWayTurnsTheErrorsSignNotThatOfAScaleFactor) {
  const auto model = model_of(
      "all: [{process: white_noise, density: 1, unit: deg/s/sqrt(Hz)}, {process: drift, slope: 1, unit: deg/h/h}, {process: "
      "scale_factor, sigma: 100, unit: ppm}]",
      kForceNoise);
  const Eigen::Matrix3d C_s_b = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const std::vector<ModelledSensor> sensors{{"upright", &model}, {"over", &model, C_s_b}};
  const noise::ImuErrorModel sum = extended_error_model("sum", 100.0, sensors);
  const auto& y = sum.axes(noise::Sensor::kGyro)[1];
  ASSERT_EQ(y.size(), 6U);
  EXPECT_EQ(y[1]->share()->weight, 0.5);
  EXPECT_EQ(y[4]->share()->weight, -0.5);
  EXPECT_EQ(y[5]->share()->weight, 0.5);
}

TEST(Extended, WhatCannotBeIsRefused) {
  const auto good = model_of("all: [{process: white_noise, density: 1, unit: deg/s/sqrt(Hz)}]", kForceNoise);
  const auto quiet = model_of("all: [{process: random_constant, sigma: 1, unit: deg/s}]", kForceNoise);
  const auto bent =
      model_of("all: [{process: white_noise, density: 1, unit: deg/s/sqrt(Hz)}, {process: misalignment, sigma: 1, unit: mrad}]",
               kForceNoise);
  const Eigen::Matrix3d tilted = geo::rotation_matrix(0.4 * Eigen::Vector3d::UnitX());
  const Eigen::Matrix3d over = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const auto refused = [&](const ModelledSensor& other) {
    const std::vector<ModelledSensor> sensors{{"good", &good}, other};
    EXPECT_THROW((void)extended_error_model("sum", 100.0, sensors), std::invalid_argument) << other.name;
  };
  refused({"tilted", &good, tilted});
  refused({"quiet", &quiet});
  // A misalignment is not: its two angles are alike.
  const std::vector<ModelledSensor> fine{{"good", &good}, {"bent", &bent, over}};
  EXPECT_NO_THROW((void)extended_error_model("sum", 100.0, fine));
}

Signals random_array(std::size_t sensors, Eigen::Index samples) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  Signals signals{geo::GpsTime::from_week(2300, 100.0), 0.01, {}};
  for (std::size_t k = 0; k < sensors; ++k) {
    SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.name = "imu" + std::to_string(k);
    sensor.values = Eigen::MatrixXd::NullaryExpr(kChannels, samples, [&] { return normal(random); });
    sensor.usable.assign(static_cast<std::size_t>(samples), kAllUsable);
  }
  return signals;
}

TEST(Extended, OffsetsThatWereTakenOffComeBackWithTheWeights) {
  const Signals signals = random_array(3, 1000);
  Signals levelled = signals;
  static_cast<void>(take_off_relative_offsets(levelled, 2.0));
  MergeOptions options{.merge = Merge::kExtended};
  options.weights = Eigen::MatrixXd(kChannels, 3);
  options.weights.rowwise() = Eigen::RowVector3d(0.5, 0.3, 0.2);
  const MergedChannel merged = merge_channel(levelled, 4, options);
  const Eigen::VectorXd sum = with_offsets(signals, levelled, 4, merged.value, options.weights.row(4).transpose());
  const Eigen::VectorXd expected =
      (0.5 * signals.sensors[0].values.row(4) + 0.3 * signals.sensors[1].values.row(4) + 0.2 * signals.sensors[2].values.row(4))
          .transpose();
  test::expect_near_matrix(sum, expected, 1e-12, "sum");
}

TEST(Extended, TheSumKeepsTheBiasOfASensorThatIsOut) {
  Signals signals = random_array(3, 6000);
  const Eigen::Vector3d bias(3.0, 0.0, 0.5);
  for (Eigen::Index k = 0; k < 3; ++k) {
    SensorSignals& sensor = signals.sensors[static_cast<std::size_t>(k)];
    sensor.values = (1e-3 * sensor.values).array() + bias(k);
  }
  for (const std::size_t sensor : {0U, 2U})  // one in the middle, one from the beginning
    for (std::size_t n = sensor == 0 ? 2000 : 0; n < (sensor == 0 ? 4500U : 1500U); ++n) signals.sensors[sensor].usable[n] = 0;
  Signals levelled = signals;
  static_cast<void>(take_off_relative_offsets(levelled, 2.0));
  MergeOptions options{.merge = Merge::kExtended};
  options.weights = Eigen::MatrixXd(kChannels, 3);
  options.weights.rowwise() = Eigen::RowVector3d(0.5, 0.3, 0.2);
  const Eigen::VectorXd sum =
      with_offsets(signals, levelled, 0, merge_channel(levelled, 0, options).value, options.weights.row(0).transpose());
  // 1e-3 of noise, of which a block's offset has the 14th part.
  EXPECT_LE((sum.array() - 1.6).abs().maxCoeff(), 6e-3);
}

TEST(Extended, OfTwoSensorsTheSumKeepsTheBiasOfTheOneThatIsOut) {
  Signals signals = random_array(2, 4000);
  signals.sensors[0].values = (1e-3 * signals.sensors[0].values).array() + 3.0;
  signals.sensors[1].values *= 1e-3;
  for (std::size_t n = 1000; n < 3000; ++n) signals.sensors[0].usable[n] = 0;
  Signals levelled = signals;
  static_cast<void>(take_off_relative_offsets(levelled, 2.0));
  MergeOptions options{.merge = Merge::kExtended};
  options.weights = Eigen::MatrixXd::Constant(kChannels, 2, 0.5);
  const Eigen::VectorXd sum =
      with_offsets(signals, levelled, 0, merge_channel(levelled, 0, options).value, options.weights.row(0).transpose());
  EXPECT_LE((sum.array() - 1.5).abs().maxCoeff(), 6e-3);  // noise of 1e-3, of one sensor at worst
}

TEST(Extended, BlocksAreMeansOfWhatMayBeUsedAllAlong) {
  Signals signals = random_array(2, 250);
  signals.sensors[1].usable[120] = 0x1F;  // one channel of one sample
  const record::MemberBlocks members = member_blocks(signals, 1.0);
  ASSERT_EQ(members.blocks.size(), 2U);  // the half block at the end is none
  EXPECT_EQ(members.names, (std::vector<std::string>{"imu0", "imu1"}));
  EXPECT_NEAR(members.blocks[1].from - signals.start, 1.0, 1e-9);
  EXPECT_TRUE(members.blocks[0].means[1]);
  EXPECT_FALSE(members.blocks[1].means[1]);
  const Channels mean = signals.sensors[0].values.middleCols(100, 100).rowwise().mean();
  test::expect_near_matrix(members.blocks[1].means[0]->gyro, mean.head<3>(), 1e-15, "gyro");
  test::expect_near_matrix(members.blocks[1].means[0]->accel, mean.tail<3>(), 1e-15, "accel");
}

}  // namespace
}  // namespace coast::array
