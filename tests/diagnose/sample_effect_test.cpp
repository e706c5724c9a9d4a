// What converters do to samples, made here sample by sample.

#include "coast/diagnose/sample_effect.hpp"

#include <gtest/gtest.h>

#include <random>

#include "coast/diagnose/correction.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"

namespace coast {
namespace {

using namespace diagnose;

const SampleEffect& sample_effect(std::string_view name) {
  for (const SampleEffect& e : sample_catalogue())
    if (e.name == name) return e;
  throw std::logic_error("no such effect");
}

/// A slow wave with white noise.
AxisSeries wave(double noise, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0.0, noise);
  AxisSeries series;
  series.white_sd = noise;
  series.values = Eigen::ArrayXd::LinSpaced(5000, 0.0, 60.0).sin();
  for (double& x : series.values) x += normal(engine);
  return series;
}

TEST(SampleEffects, AreComplete) {
  for (const SampleEffect& e : sample_catalogue()) {
    for (const std::string_view words : {e.name, e.parameter, e.unit, e.equation, e.meaning, e.separating_manoeuvre, e.source})
      EXPECT_FALSE(words.empty()) << e.name;
    EXPECT_TRUE(e.find != nullptr && e.model != nullptr) << e.name;
  }
}

TEST(SampleEffects, OrdinarySamplesBearNoMark) {
  for (const SampleEffect& e : sample_catalogue())
    for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_FALSE(e.find(wave(1e-3, seed)).has_value()) << e.name << seed;
}

TEST(SampleEffects, AFileWithFewDigitsIsNotCoarse) {
  AxisSeries series = wave(1e-2, 1);
  series.values = (series.values * 1e4).round() / 1e4;
  EXPECT_FALSE(sample_effect("quantisation").find(series).has_value());
}

TEST(SampleEffects, ACoarseStepIsFound) {
  AxisSeries series = wave(1e-3, 2);
  series.values = 0.0037 * (series.values / 0.0037).round();
  const std::optional<double> step = sample_effect("quantisation").find(series);
  ASSERT_TRUE(step.has_value());
  EXPECT_NEAR(*step, 0.0037, 1e-12);
  EXPECT_FALSE(sample_effect("saturation").find(series).has_value());
  series.rounding_stated = true;
  EXPECT_FALSE(sample_effect("quantisation").find(series).has_value());
}

TEST(SampleEffects, AnUpperAndALowerLimitAreFound) {
  AxisSeries series = wave(1e-3, 3);
  AxisSeries high = series;
  high.values = high.values.min(0.9);
  EXPECT_NEAR(sample_effect("saturation").find(high).value_or(0.0), 0.9, 1e-12);
  AxisSeries low = series;
  low.values = low.values.max(-0.8);
  EXPECT_NEAR(sample_effect("saturation").find(low).value_or(0.0), -0.8, 1e-12);
}

// Half a sine beyond the limit, cut at 80 % of its height: the cubic with the slopes at the cut leaves a tenth of what was
// lost.
TEST(SampleEffects, WhatASaturatedSensorMissedIsMended) {
  MissionInput input;
  input.imu.rate_hz = 100.0;
  const geo::GpsTime start = geo::GpsTime::from_week(2374, 1000.0);
  constexpr double kLimit = 0.8;
  for (int i = 0; i < 1000; ++i) {
    const double rate = std::sin(0.02 * i);
    input.imu.samples.push_back(
        {start + 0.01 * (i + 1), 0.01, {0.0, 0.0, 0.01 * std::clamp(rate, -kLimit, kLimit)}, Eigen::Vector3d::Zero()});
  }
  const auto sum = [&] {
    double total = 0.0;
    for (const record::ImuSample& s : input.imu.samples) total += s.dtheta.z() > 0.0 ? s.dtheta.z() : 0.0;
    return total;
  };
  double positive = 0.0;
  for (int i = 0; i < 1000; ++i) positive += 0.01 * std::max(0.0, std::sin(0.02 * i));
  const double lost = positive - sum();
  sample_effect("saturation").model(input, Site::kGyro, 2, kLimit);
  EXPECT_GT(lost, 0.0);
  EXPECT_LT(std::abs(positive - sum()), 0.15 * lost);
}

// Turns of 6 s on a car that shakes: the noise crosses the limit on the way up and down, and in eight samples it hides the
// slope. What is left of the turned angle is to be what the added noise says it is: of twelve turns the rms is within twice
// that (of chi-square 1.66 times is exceeded at 0.1 %), and above a tenth; and half of the rms that was lost is to come back.
TEST(SampleEffects, TurnsOnAShakingCarAreMendedAndTheirUncertaintyIsTold) {
  MissionInput input;
  input.imu.rate_hz = 100.0;
  input.setup.model = noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
sensor: test
gyro: {all: [{process: white_noise, density: 0.3, unit: deg/s/sqrt(Hz)}]}
accel: {all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}]}
)",
                                                                "model.yaml"));
  constexpr double kLimit = 0.25, kPeak = 0.5, kNoise = 0.05;
  constexpr int kTurns = 12, kTurn = 2400, kLength = 600;  // samples
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal(0.0, kNoise);
  const geo::GpsTime start = geo::GpsTime::from_week(2374, 1000.0);
  std::vector<double> missing(kTurns, 0.0);
  for (int i = 0; i < kTurns * kTurn; ++i) {
    const int k = i % kTurn;
    const double rate = (k < kLength ? kPeak * std::sin(geo::kPi * k / kLength) : 0.0) + normal(engine);
    const double measured = std::min(rate, kLimit);
    missing[static_cast<std::size_t>(i / kTurn)] += 0.01 * (rate - measured);
    input.imu.samples.push_back({start + 0.01 * (i + 1), 0.01, {0.0, 0.0, 0.01 * measured}, Eigen::Vector3d::Zero()});
  }
  const record::ImuRecording clipped = input.imu;
  sample_effect("saturation").model(input, Site::kGyro, 2, kLimit);
  double lost = 0.0, left = 0.0, told = 0.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    double added = 0.0;
    for (int i = turn * kTurn; i < (turn + 1) * kTurn; ++i)
      added +=
          input.imu.samples[static_cast<std::size_t>(i)].dtheta.z() - clipped.samples[static_cast<std::size_t>(i)].dtheta.z();
    lost += std::pow(missing[static_cast<std::size_t>(turn)], 2);
    left += std::pow(missing[static_cast<std::size_t>(turn)] - added, 2);
  }
  const double density = input.setup.model.white_density(noise::Sensor::kGyro, 2).value;
  for (const record::NoiseLevel& level : input.imu.noise) told += (level.gyro.z() - 1.0) * density * (level.to - level.from);
  EXPECT_LT(left, 0.25 * lost);
  EXPECT_LT(left, 4.0 * told);
  EXPECT_GT(left, 0.01 * told);
}

}  // namespace
}  // namespace coast
