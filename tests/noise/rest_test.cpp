// Recordings that are moved: where, and that noise alone is no motion.

#include "coast/noise/rest.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "coast/geo/units.hpp"

namespace coast::noise {
namespace {

constexpr double kRestRate = 50.0;  // Hz

/// Six axes of white noise and a random walk, with what `motion` adds to an axis at a time.
StaticRecording moved_record(double seconds, unsigned seed, double noise,
                             const std::function<double(std::size_t, double)>& motion) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  StaticRecording r{"imu.csv", 1.0 / kRestRate, {}, {}};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    std::vector<double> values;
    double walk = 0.0;
    for (int k = 0; k < static_cast<int>(seconds * kRestRate); ++k) {
      walk += 1e-3 * noise * normal(random);
      values.push_back(noise * normal(random) + walk + motion(axis, k / kRestRate));
    }
    r.axes.push_back(StaticSignal::regular(std::move(values), 1.0 / kRestRate));
  }
  return r;
}

double no_motion(std::size_t, double) {
  return 0.0;
}

TEST(RestTest, NoiseIsNoMotion) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Rest rest = rest_of(moved_record(600.0, seed, std::pow(10.0, -0.4 * seed), no_motion));  // 1 to 2.5e-4
    EXPECT_EQ(rest.moved, 0.0) << seed;
    ASSERT_EQ(rest.places.size(), 1U) << seed;
    EXPECT_NEAR(rest.places[0].length(), 600.0, 1e-9);
  }
}

// Steps of 0.05 rad/s and m/s^2, five times the noise: most means are alike, and those that are not jump.
TEST(RestTest, CoarseStepsAreNoMotion) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    StaticRecording coarse = moved_record(600.0, seed, 0.01, no_motion);
    for (StaticSignal& signal : coarse.axes) {
      std::vector<double> each_fifth;  // at 10 Hz
      for (std::size_t i = 0; i < signal.values.size(); i += 5)
        each_fifth.push_back(std::round(signal.values[i] / 0.05 + 0.3) * 0.05);
      signal = StaticSignal::regular(std::move(each_fifth), 5.0 / kRestRate);
    }
    EXPECT_EQ(rest_of(coarse).moved, 0.0) << seed;
  }
}

// Turned by hand to another pose between 200 and 210 s: by 20 deg/s, and gravity goes from z to x.
TEST(RestTest, FindsTheStretchesBetweenTurns) {
  const auto turned = [](std::size_t axis, double t) {
    const double angle = std::clamp((t - 200.0) / 10.0, 0.0, 1.0) * geo::kPi / 2.0;
    if (axis == 1) return t > 200.0 && t < 210.0 ? geo::kPi / 20.0 : 0.0;
    if (axis == 3) return 9.8 * std::sin(angle);
    return axis == 5 ? -9.8 * std::cos(angle) : 0.0;
  };
  const Rest rest = rest_of(moved_record(500.0, 1, 0.01, turned));
  EXPECT_FALSE(rest.at_rest());
  ASSERT_EQ(rest.places.size(), 2U);
  EXPECT_EQ(rest.places[0].from, 0.0);
  EXPECT_NEAR(rest.places[0].to, 198.0, 2.0);
  EXPECT_NEAR(rest.places[1].from, 212.0, 2.0);
  EXPECT_NEAR(rest.places[1].to, 500.0, 1e-9);
}

TEST(RestTest, AVehicleUnderWayIsNeverAtRest) {
  const auto drive = [](std::size_t axis, double t) {
    return (axis < 3 ? 0.2 : 1.0) * std::sin(0.7 * t + static_cast<double>(axis)) * std::sin(0.13 * t);
  };
  const Rest rest = rest_of(moved_record(600.0, 2, 0.01, drive));
  EXPECT_FALSE(rest.at_rest());
  EXPECT_TRUE(rest.places.empty());
}

TEST(RestTest, ATouchOfTheTableIsTold) {
  const Rest rest = rest_of(moved_record(
      1000.0, 3, 0.01, [](std::size_t axis, double t) { return axis == 0 && t > 500.0 && t < 501.5 ? 0.2 : 0.0; }));
  EXPECT_TRUE(rest.at_rest());
  EXPECT_NEAR(rest.moved, 3.0, 1.01);
}

// A temperature that drifts, and a bias of the size that cheap gyros have, are the sensor's.
TEST(RestTest, SlowDriftIsNoMotion) {
  const Rest rest =
      rest_of(moved_record(1800.0, 4, 0.01, [](std::size_t, double t) { return 0.03 * (1.0 - std::exp(-t / 100.0)); }));
  EXPECT_EQ(rest.moved, 0.0);
}

}  // namespace
}  // namespace coast::noise
