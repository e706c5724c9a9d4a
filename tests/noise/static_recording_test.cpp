// Recordings at rest as signals: values, holes, rates, and the turn-on bias of their levels.

#include "coast/noise/static_recording.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coast/record/error.hpp"

namespace coast::noise {
namespace {

/// Sample k of every axis has the value k + axis/10 over its interval, whatever its length.
record::ImuRecording counting(const std::vector<double>& steps, double rate_hz) {
  record::ImuRecording imu;
  imu.source = "imu.csv";
  imu.rate_hz = rate_hz;
  geo::GpsTime t = geo::GpsTime::from_week(2374, 1000.0);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    t = t + steps[k];
    const auto value = static_cast<double>(k);
    imu.samples.push_back({t, steps[k], steps[k] * Eigen::Vector3d(value, value + 0.1, value + 0.2),
                           steps[k] * Eigen::Vector3d(value + 0.3, value + 0.4, value + 0.5)});
  }
  return imu;
}

TEST(StaticRecordingTest, ValuesAreIncrementsOverTheirIntervalInSensorAxes) {
  const StaticRecording r = static_recording(counting(std::vector<double>(50, 0.01), 100.0));
  EXPECT_NEAR(r.interval, 0.01, 1e-15);
  EXPECT_TRUE(r.remarks.empty());
  ASSERT_EQ(r.axes.size(), 6U);
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < 50; ++k) {
      EXPECT_NEAR(r.of(Sensor::kGyro, axis).values[k], static_cast<double>(k) + 0.1 * axis, 1e-12);
      EXPECT_NEAR(r.of(Sensor::kAccel, axis).values[k], static_cast<double>(k) + 0.1 * (axis + 3), 1e-12);
    }
  EXPECT_EQ(r.axes[0].length(), 50U);
}

TEST(StaticRecordingTest, AHoleIsRoundedToTheGridAndItsBridgedSampleLeftOut) {
  std::vector<double> steps(20, 0.01);
  steps[10] = 0.0478;  // 3.78 samples are missing before sample 10
  const StaticRecording r = static_recording(counting(steps, 100.0));
  const StaticSignal& x = r.axes[0];
  ASSERT_EQ(x.runs.size(), 2U);
  EXPECT_EQ(x.runs[0].count, 10U);
  EXPECT_EQ(x.runs[1].start, 15U);  // 10 samples, and a step of 4.78 intervals taken as 5
  EXPECT_EQ(x.runs[1].count, 9U);
  EXPECT_EQ(x.values.size(), 19U);
  EXPECT_NEAR(x.values[10], 11.0, 1e-12);
  ASSERT_EQ(r.remarks.size(), 1U);
  EXPECT_NE(r.remarks[0].find("by 0.22 of one"), std::string::npos) << r.remarks[0];
}

TEST(StaticRecordingTest, MillisecondTagsDoNotMakeAnotherRate) {
  // 120 Hz with tags in whole ms: steps of 8, 8 and 9 ms, median 8, mean 8.333.
  std::vector<double> steps;
  for (int i = 0; i < 300; ++i) steps.push_back(i % 3 == 2 ? 0.009 : 0.008);
  EXPECT_NEAR(1.0 / static_recording(counting(steps, 125.0)).interval, 120.0, 1e-9);
}

TEST(StaticRecordingTest, APartIsCutOutByTime) {
  const StaticRecording r = static_recording(counting(std::vector<double>(100, 0.01), 100.0), {0.2, 0.5});
  ASSERT_EQ(r.axes[0].values.size(), 30U);
  EXPECT_NEAR(r.axes[0].values.front(), 20.0, 1e-9);  // its interval begins at 0.2 s
  EXPECT_THROW(static_cast<void>(static_recording(counting(std::vector<double>(100, 0.01), 100.0), {2.0, {}})), InputError);
}

TEST(StaticRecordingTest, RatesAreSharedOrRefused) {
  const auto of_rate = [](double hz) { return static_recording(counting(std::vector<double>(100, 1.0 / hz), hz)); };
  std::vector<StaticRecording> alike{of_rate(100.0), of_rate(100.1)};
  share_interval(alike);
  EXPECT_EQ(alike[0].axes[2].interval, alike[1].axes[5].interval);
  EXPECT_EQ(alike[0].remarks.size(), 1U);
  std::vector<StaticRecording> other{of_rate(100.0), of_rate(104.0)};
  EXPECT_THROW(share_interval(other), InputError);
}

TEST(TurnOnBiasTest, ComesFromWhatTheLevelsCanTell) {
  using Levels = std::vector<std::array<double, 3>>;
  const Levels mems{{0.006, -0.008, -0.005}, {0.006, -0.007, -0.005}};
  EXPECT_NEAR(turn_on_bias(Sensor::kGyro, mems).sigma, std::sqrt((36.0 + 64.0 + 25.0 + 36.0 + 49.0 + 25.0) / 6.0) * 1e-3,
              1e-12);
  const Levels tactical{{5e-5, 0.0, 1e-5}, {5.2e-5, 0.0, 1e-5}};  // Earth's rate and 0.4 deg/h between recordings
  EXPECT_NEAR(turn_on_bias(Sensor::kGyro, tactical).sigma, 2e-6 / std::sqrt(2.0 * 3.0), 1e-12);
  EXPECT_NEAR(turn_on_bias(Sensor::kGyro, Levels{tactical.front()}).sigma, 3.0 * 7.292115e-5, 1e-12);

  const Levels level{{0.0, 0.0, -9.81}, {0.0, 0.0, -9.80}};
  EXPECT_NEAR(turn_on_bias(Sensor::kAccel, level).sigma, 0.01 / std::sqrt(6.0), 1e-12);
  const Levels off{{0.0, 0.0, -9.90665}, {0.0, 0.0, -9.90665}};
  EXPECT_NEAR(turn_on_bias(Sensor::kAccel, off).sigma, 0.1, 1e-12);
  EXPECT_NEAR(turn_on_bias(Sensor::kAccel, Levels{level.front()}).sigma, 0.02 * 9.80665, 1e-12);
  EXPECT_NE(turn_on_bias(Sensor::kAccel, Levels{level.front()}).source.find("default"), std::string::npos);
}

}  // namespace
}  // namespace coast::noise
