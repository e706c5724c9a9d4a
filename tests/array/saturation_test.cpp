#include "coast/array/saturation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace coast::array {
namespace {

constexpr double kTurnInterval = 0.01;

/// Turns about x with this amplitude, 0.8 Hz, beside noise; clipped to a range and rounded to a step.
record::ImuRecording turning(double amplitude, double range, double step, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 0.002);
  record::ImuRecording recording;
  for (int n = 0; n < 6000; ++n) {
    record::ImuSample sample;
    sample.t = geo::GpsTime::from_week(2300, 1000.0 + kTurnInterval * (n + 1));
    sample.dt = kTurnInterval * (1.0 + 0.01 * noise(random));  // as a clock has them
    Eigen::Vector3d rate(amplitude * std::sin(0.05 * n), 0.1, 0.0);
    for (double& value : rate) value = std::clamp(std::round((value + noise(random)) / step) * step, -range, range);
    sample.dtheta = rate * sample.dt;
    sample.dv = Eigen::Vector3d(noise(random), noise(random), -9.8 + noise(random)) * sample.dt;
    recording.samples.push_back(sample);
  }
  return recording;
}

TEST(Saturation, IsWhereMotionGoesBeyondTheRange) {
  const record::ImuRecording recording = turning(5.0, 4.0, 0.001, 1);
  const Saturation saturation = find_saturation(recording);
  ASSERT_TRUE(saturation.any());
  EXPECT_NEAR(saturation.most[0], 4.0, 1e-9);
  for (std::size_t c = 1; c < 6; ++c) EXPECT_EQ(saturation.count[c], 0U) << c;
  // Beyond four fifths of the amplitude a sine is for 2 acos(0.8)/pi = 41 % of the time; noise moves each of the 190 crossings
  // by less than a sample.
  EXPECT_NEAR(static_cast<double>(saturation.count[0]), 0.4097 * 6000, 190.0);
  for (std::size_t i = 0; i < recording.samples.size(); ++i) {
    const double rate = recording.samples[i].dtheta.x() / recording.samples[i].dt;
    EXPECT_EQ(saturation.samples[i] & 1, std::abs(rate) > 4.0 - 1e-6 ? 1 : 0) << i;
  }
}

TEST(Saturation, IsNotWithinTheRangeNorInCoarseNoise) {
  EXPECT_FALSE(find_saturation(turning(3.9, 4.0, 0.001, 2)).any());
  EXPECT_FALSE(find_saturation(turning(0.0, 4.0, 0.001, 3)).any());   // 15 different values
  EXPECT_FALSE(find_saturation(turning(0.0, 4.0, 0.0001, 4)).any());  // 150
  record::ImuRecording stuck = turning(3.9, 4.0, 0.001, 5);
  for (std::size_t i = 3000; i < 3500; ++i) stuck.samples[i].dtheta.x() = 4.5 * stuck.samples[i].dt;
  EXPECT_FALSE(find_saturation(stuck).any());
}

TEST(Saturation, IsMarkedAsFarAsTheResamplingReaches) {
  record::ImuRecording recording = turning(3.0, 4.0, 0.001, 6);
  Saturation saturation;
  saturation.samples.assign(recording.samples.size(), 0);
  saturation.samples[2000] = 1;  // the interval ends at 1020.01 s
  saturation.count[0] = 1;
  const Grid grid{geo::GpsTime::from_week(2300, 1000.0), kTurnInterval, 6000};
  SensorSignals sensor;
  const std::vector<std::uint8_t> wrong =
      mark_saturation(sensor, saturation, recording, grid, LinearLag{grid.start, 0.1, 0.0});  // ten columns earlier
  for (std::size_t n = 0; n < grid.samples; ++n) {
    if (n >= 1990 - 16 && n <= 1990 + 16) {
      EXPECT_EQ(sensor.limited[n], 0x07) << n;
    } else if (n + 1 < 1990 - 16 || n > 1990 + 17) {
      EXPECT_EQ(sensor.limited[n], 0) << n;
    }
    if (n >= 1989 && n <= 1991) {
      EXPECT_EQ(wrong[n], 0x07) << n;
    } else if (n < 1988 || n > 1992) {
      EXPECT_EQ(wrong[n], 0) << n;
    }
  }
}

TEST(Saturation, IsLeftOutWhereAnotherSensorIsWithinItsRange) {
  SensorSignals sensor;
  sensor.usable.assign(4, kAllUsable);
  Signals signals{geo::GpsTime::from_week(2300, 1000.0), kTurnInterval, {sensor, sensor}};
  signals.sensors[1].usable[3] = 0;  // a gap
  leave_out_where_others_are_not(signals, {{0x07, 0x07, 0, 0x07}, {0, 0x07, 0, 0x07}});
  EXPECT_EQ(signals.sensors[0].usable, (std::vector<std::uint8_t>{0x38, kAllUsable, kAllUsable, kAllUsable}));
  EXPECT_EQ(signals.sensors[1].usable, (std::vector<std::uint8_t>{kAllUsable, kAllUsable, kAllUsable, 0}));
}

TEST(Saturation, OfRatesLimitsTheForcesOfAll) {
  SensorSignals sensor;
  sensor.usable.assign(2, kAllUsable);
  Signals signals{geo::GpsTime::from_week(2300, 1000.0), kTurnInterval, {sensor, sensor}};
  signals.sensors[0].limited = {0x07, 0};
  mark_forces_moved_by_limited_rates(signals);
  EXPECT_EQ(signals.sensors[0].limited, (std::vector<std::uint8_t>{0x3F, 0}));
  EXPECT_EQ(signals.sensors[1].limited, (std::vector<std::uint8_t>{0x38, 0}));
  EXPECT_EQ(signals.sensors[1].usable[0], kAllUsable);
}

}  // namespace
}  // namespace coast::array
