// Shares: error models of a sum of several IMUs.

#include "coast/noise/share.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coast/io/yaml.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/error.hpp"

namespace coast::noise {
namespace {

constexpr const char* kSharedModel = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: share, of: left, weight: 0.25, own: {process: white_noise, density: 0.8, unit: deg/s/sqrt(Hz)}},
        {process: share, of: left, weight: -0.25, own: {process: random_constant, sigma: 2, unit: deg/s}},
        {process: share, of: "the right one's", weight: 0.75, own: {process: white_noise, density: 0.4, unit: deg/s/sqrt(Hz)}},
        {process: share, of: "the right one's", weight: 0.75, own: {process: misalignment, sigma: 1, unit: mrad}}]
accel: {all: [{process: white_noise, density: 1, unit: ug/sqrt(Hz)}]}
)";

ImuErrorModel shared_model() {
  return ImuErrorModel::from(io::parse_yaml(kSharedModel, "model.yaml"));
}

TEST(Share, ActsWithItsWeightAndKeepsItsOwnStates) {
  const ImuErrorModel model = shared_model();
  EXPECT_EQ(model.members(), (std::vector<std::string>{"left", "the right one's"}));
  const auto& x = model.axes(Sensor::kGyro)[0];
  ASSERT_EQ(x.size(), 5U);  // a misalignment is two angles
  // Variances of independent noise add up with the squares of the weights: (0.25 0.8)^2 + (0.75 0.4)^2.
  EXPECT_NEAR(model.white_density(Sensor::kGyro, 0).value, 0.13 * geo::kDegree * geo::kDegree, 1e-15);
  EXPECT_NEAR(model.bias_sd(Sensor::kGyro, 0), 0.5 * geo::kDegree, 1e-15);
  Eigen::RowVectorXd h(1);
  x[1]->output(h);
  EXPECT_EQ(h(0), -0.25);
  Eigen::MatrixXd P(1, 1);
  x[1]->initial_covariance(P);
  EXPECT_NEAR(P(0, 0), std::pow(2.0 * geo::kDegree, 2), 1e-15);
  EXPECT_EQ(x[3]->input(), Input::kNextAxis);
  EXPECT_EQ(x[4]->share()->member, "the right one's");
}

TEST(Share, IsWrittenAndReadAgain) {
  const std::string text = shared_model().yaml();
  EXPECT_EQ(ImuErrorModel::from(io::parse_yaml(text, "again.yaml")).yaml(), text);
}

TEST(Share, StaysOneWhenWhiteNoiseIsScaled) {
  const ImuErrorModel scaled = shared_model().with_white_noise_scaled(Sensor::kGyro, Eigen::Vector3d::Constant(3.0));
  EXPECT_EQ(scaled.members().size(), 2U);
  EXPECT_NEAR(scaled.white_density(Sensor::kGyro, 2).value, 9.0 * 0.13 * geo::kDegree * geo::kDegree, 1e-14);
}

TEST(Share, SpoiledEntriesAreRefused) {
  const std::string own = "own: {process: random_constant, sigma: 1, unit: deg/s}}";
  const std::string share = "{process: share, of: a, ";
  const std::vector<std::string> entries{share + "weight: 0, " + own, share + "weight: 1.5, " + own, share + "weight: 1}",
                                         "{process: share, weight: 1, " + own,
                                         share + "weight: 1, own: {process: share, of: b, weight: 1, " + own + "}"};
  for (const std::string& entry : entries) {
    const std::string text = "schema: coast.imu_error_model/1\ngyro: {all: [" + entry + "]}\naccel: {all: []}\n";
    EXPECT_THROW((void)ImuErrorModel::from(io::parse_yaml(text, "m.yaml")), InputError) << entry;
  }
}

}  // namespace
}  // namespace coast::noise
