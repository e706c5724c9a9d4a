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
  sensor.usable.assign(grid.samples, kAllUsable);
  mark_saturation(sensor, saturation, recording, grid, LinearLag{grid.start, 0.1, 0.0});  // ten columns earlier
  for (std::size_t n = 0; n < grid.samples; ++n) {
    const bool near = n >= 1990 - 16 && n <= 1990 + 16;
    if (near) {
      EXPECT_EQ(sensor.limited[n], 0x07) << n;
    } else if (n + 1 < 1990 - 16 || n > 1990 + 17) {
      EXPECT_EQ(sensor.limited[n], 0) << n;
    }
    if (n >= 1989 && n <= 1991) {
      EXPECT_EQ(sensor.usable[n], 0x38) << n;
    } else if (n < 1988 || n > 1992) {
      EXPECT_EQ(sensor.usable[n], kAllUsable) << n;
    }
  }
  Signals all{grid.start, grid.dt, {sensor, sensor}};
  use_where_all_are_limited(all);
  EXPECT_EQ(all.sensors[0].usable[1990], kAllUsable);
  Signals signals{grid.start, grid.dt, {sensor, sensor}};
  signals.sensors[1].limited.clear();
  signals.sensors[1].usable.assign(grid.samples, kAllUsable);
  use_where_all_are_limited(signals);
  EXPECT_EQ(signals.sensors[0].usable[1990], 0x38);
  mark_forces_moved_by_limited_rates(signals);
  EXPECT_EQ(signals.sensors[0].limited[1990], 0x3F);
  EXPECT_EQ(signals.sensors[1].limited[1990], 0x38);
  EXPECT_EQ(signals.sensors[1].limited[100], 0);
  EXPECT_EQ(signals.sensors[1].usable[1990], kAllUsable);
}

}  // namespace
}  // namespace coast::array
