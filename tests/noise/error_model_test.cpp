#include "coast/noise/error_model.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "coast/record/error.hpp"
#include "noise/entries.hpp"

namespace coast {
namespace {

using noise::Sensor;
using test::model_of;

constexpr const char* kModel = R"(schema: coast.imu_error_model/1
sensor: 'it''s "quoted": #1'
rate_hz: 100
gyro:
  all: [{process: white_noise, density: 0.15, unit: deg/sqrt(h)}, {process: random_constant, sigma: 0.75, unit: deg/h},
        {process: misalignment, sigma: 0.3, unit: mrad}, {process: scale_factor, sigma: 300, unit: ppm}]
  z:
    - {process: white_noise, density: 3e-5, unit: rad/s/sqrt(Hz)}
    - {process: white_noise, density: 4e-5, unit: rad/s/sqrt(Hz)}
accel:
  x: [{process: random_constant, sigma: 3e-3, unit: m/s^2}, {process: gauss_markov, sigma: 4e-3, unit: m/s^2, correlation_time_s: 9}]
  y: [{process: white_noise, variance_per_sample: 3.6e-5, unit: (m/s^2)^2}]
  z: []
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = kModel;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ErrorModel, AxesReplaceAll) {
  const auto model = model_of(kModel);
  EXPECT_EQ(model.axes(Sensor::kGyro)[0].size(), 5u);  // a misalignment is two angles
  EXPECT_EQ(model.axes(Sensor::kGyro)[1].size(), 5u);
  EXPECT_EQ(model.axes(Sensor::kGyro)[2].size(), 2u);
  EXPECT_EQ(model.axes(Sensor::kAccel)[2].size(), 0u);
  EXPECT_EQ(model.sensor_name(), "it's \"quoted\": #1");
}

TEST(ErrorModel, WhiteDensitiesAndBiasVariancesAdd) {
  const auto model = model_of(kModel);
  EXPECT_NEAR(std::sqrt(model.white_density(Sensor::kGyro, 2).value), 5e-5, 1e-18);
  EXPECT_NEAR(model.white_density(Sensor::kAccel, 1).value, 3.6e-7, 1e-20);
  EXPECT_NEAR(model.bias_sd(Sensor::kAccel, 0), 5e-3, 1e-16);
  EXPECT_NEAR(model.bias_sd(Sensor::kGyro, 0), 0.75 * M_PI / 180.0 / 3600.0, 1e-19);  // scale and angles are no bias
  EXPECT_EQ(model.bias_sd(Sensor::kAccel, 2), 0.0);
}

// An AR(1) has the density (sigma / (1 - a))^2 dt at frequency zero (the sum of its autocovariances, times dt).
TEST(ErrorModel, WhatForgetsFastIsWhiteForTheFilter) {
  const auto model = model_of(R"(schema: coast.imu_error_model/1
gyro:
  x: [{process: ar, coefficients: [0.3], innovation_sigma: 0.01, unit: rad/s, rate_hz: 100}]
  y: [{process: ar, coefficients: [1.9, -0.9925], innovation_sigma: 0.01, unit: rad/s, rate_hz: 100}]
  z: [{process: ar, coefficients: [0.9999], innovation_sigma: 0.01, unit: rad/s, rate_hz: 100}]
accel: {all: []}
)");
  EXPECT_NEAR(model.white_density(Sensor::kGyro, 0).value, std::pow(0.01 / 0.7, 2) / 100.0, 1e-15);
  EXPECT_EQ(model.bias_sd(Sensor::kGyro, 0), 0.0);
  // Rings at 4.9 Hz for 2.7 s: nothing that a filter of positions could follow.
  EXPECT_NEAR(model.white_density(Sensor::kGyro, 1).value, std::pow(0.01 / 0.0925, 2) / 100.0, 1e-13);
  EXPECT_EQ(model.bias_sd(Sensor::kGyro, 1), 0.0);
  // Forgets in 100 s: that is a bias.
  EXPECT_EQ(model.white_density(Sensor::kGyro, 2).value, 0.0);
  EXPECT_NEAR(model.bias_sd(Sensor::kGyro, 2), 0.01 / std::sqrt(1.0 - 0.9999 * 0.9999), 1e-8);
}

TEST(ErrorModel, ScalesTheWhiteNoiseOfOneSensor) {
  const auto model = model_of(kModel);
  const auto scaled = model.with_white_noise_scaled(Sensor::kGyro, {1.0, 2.0, 3.0});
  EXPECT_EQ(scaled.white_density(Sensor::kGyro, 0).value, model.white_density(Sensor::kGyro, 0).value);
  EXPECT_NEAR(scaled.white_density(Sensor::kGyro, 1).value, 4.0 * model.white_density(Sensor::kGyro, 1).value, 1e-20);
  EXPECT_NEAR(std::sqrt(scaled.white_density(Sensor::kGyro, 2).value), 1.5e-4, 1e-17);
  EXPECT_NEAR(scaled.white_density(Sensor::kAccel, 1).value, 3.6e-7, 1e-20);
  EXPECT_NEAR(scaled.bias_sd(Sensor::kAccel, 0), 5e-3, 1e-16);
}

TEST(ErrorModel, WrittenModelIsReadAsTheSame) {
  const auto model = model_of(kModel);
  const auto again = model_of(model.yaml());
  EXPECT_EQ(again.yaml(), model.yaml());  // 17 digits: a second writing changes nothing
  EXPECT_EQ(again.sensor_name(), model.sensor_name());
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel})
    for (int axis = 0; axis < 3; ++axis) {
      const auto& a = again.axes(sensor)[static_cast<std::size_t>(axis)];
      const auto& b = model.axes(sensor)[static_cast<std::size_t>(axis)];
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i]->input(), b[i]->input());
      EXPECT_NEAR(again.bias_sd(sensor, axis), model.bias_sd(sensor, axis), 1e-15 * model.bias_sd(sensor, axis));
      EXPECT_NEAR(again.white_density(sensor, axis).value, model.white_density(sensor, axis).value,
                  1e-15 * model.white_density(sensor, axis).value);
    }
}

TEST(ErrorModel, EveryRegisteredProcessSurvivesWriting) {
  std::string text = "schema: coast.imu_error_model/1\nrate_hz: 200\n";
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel}) {
    text += sensor == Sensor::kGyro ? "gyro:\n  all:\n" : "accel:\n  all:\n";
    for (const noise::Registration& r : noise::registry())
      text += fmt::format("    - {}\n", sensor == Sensor::kGyro ? r.gyro_example : r.accel_example);
    text += sensor == Sensor::kGyro ? "    - {process: quantisation, step: 0.01, unit: deg/s}\n"
                                    : "    - {process: quantisation, step: 1, unit: mg}\n";
  }
  const auto model = model_of(text);
  EXPECT_EQ(model.axes(Sensor::kGyro)[2].size(), noise::registry().size() + 2);  // two angles of the misalignment
  const auto again = model_of(model.yaml());
  EXPECT_EQ(again.yaml(), model.yaml());
  EXPECT_EQ(again.axes(Sensor::kAccel)[1].size(), model.axes(Sensor::kAccel)[1].size());
}

struct Spoiled {
  const char* from;
  const char* to;
  long line;
};

TEST(ErrorModel, SpoiledFilesAreRefusedWithTheirLine) {
  for (const Spoiled& s :
       {Spoiled{"coast.imu_error_model/1", "coast.imu_error_model/9", 1}, Spoiled{"rate_hz: 100", "rate_hz: 0", 3},
        Spoiled{"rate_hz: 100", "rate: 100", 12},  // a variance per sample without a rate
        Spoiled{"sigma: 0.75, unit: deg/h", "sigma: 0.75, unit: mg", 5}, Spoiled{"density: 4e-5", "density: -4e-5", 9},
        Spoiled{"  z: []\n", "", 11}, Spoiled{"  z: []\n", "  z: []\n  up: []\n", 14},
        Spoiled{"correlation_time_s: 9", "correlation_time_s: 0", 11},
        Spoiled{"correlation_time_s: 9", "correlation_time_s: 9, colour: red", 11}, Spoiled{"accel:", "accelerometer:", 1}}) {
    try {
      (void)model_of(with(s.from, s.to));
      ADD_FAILURE() << "accepted: " << s.to;
    } catch (const InputError& e) {
      EXPECT_EQ(e.parts().line, s.line) << e.what();
      EXPECT_EQ(e.parts().file, "model.yaml");
    }
  }
}

TEST(ErrorModel, EveryShippedProfileLoads) {
  const std::filesystem::path folder = std::filesystem::path(COAST_SOURCE_DIR) / "configs/imu";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const auto model = noise::ImuErrorModel::from(io::load_yaml(entry.path()));
    for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel})
      for (int axis = 0; axis < 3; ++axis) EXPECT_GT(model.white_density(sensor, axis).value, 0.0) << entry.path();
  }
  EXPECT_GT(count, 10);
}

}  // namespace
}  // namespace coast
