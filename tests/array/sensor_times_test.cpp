#include "coast/array/sensor_times.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coast::array {
namespace {

constexpr int kWeek = 2300;

/// Packets of a device that samples every (1 + drift) 10 ms from `first_s` on: rate about x is the true time of the sample.
struct Device {
  double first_s = 1000.0;
  double drift_ppm = 0.0;
  bool has_gps = false;
  std::int64_t pulse_every = 0;

  [[nodiscard]] double time(std::int64_t n) const { return first_s + 0.01 * (1.0 + 1e-6 * drift_ppm) * static_cast<double>(n); }
  [[nodiscard]] record::PacketRecording record(std::int64_t count, std::uint64_t seed) const {
    std::mt19937_64 generator(seed);
    std::exponential_distribution<double> delay(1.0 / 0.002);
    record::PacketRecording recording;
    recording.source = "device";
    for (std::int64_t n = 0; n < count; ++n) {
      record::Packet packet;
      packet.counter = n % 65536;
      packet.arrival_s = time(n) - 700.0 + delay(generator);  // the computer counts from elsewhere
      if (has_gps) packet.master_s = time(n);
      if (pulse_every > 0 && n % pulse_every == 0) packet.pulse = n / pulse_every;
      packet.row = recording.rates.size();
      recording.packets.push_back(packet);
      recording.rates.emplace_back(time(n), 0.0, 0.0);
      recording.forces.emplace_back(0.0, 0.0, -9.8);
    }
    return recording;
  }
};

const Counting kCounting{.interval_s = 0.01, .modulus = 65536};

/// Largest difference of the tags from the true times that the rates carry.
double largest_error(const record::ImuRecording& imu) {
  double largest = 0.0;
  for (const record::ImuSample& sample : imu.samples)
    largest = std::max(largest, std::abs(sample.t.sow() - sample.dtheta.x() / sample.dt));
  return largest;
}

TEST(SensorTimes, ByPacketsAreGpsTimes) {
  const Device master{.has_gps = true};
  const Device device{.first_s = 1000.0042, .drift_ppm = -35.0};
  const ClockFit computer = computer_clock_of(master.record(60000, 1), kCounting);
  const TimedRecording timed = time_by_packets(device.record(60000, 2), kCounting, computer, kWeek);
  ASSERT_EQ(timed.imu.samples.size(), 60000U);
  EXPECT_EQ(timed.imu.samples.front().t.week(), kWeek);
  EXPECT_LT(largest_error(timed.imu), 1e-4);  // what is asked of a synchronisation by software
  EXPECT_NEAR(timed.clocks.front().drift_ppm, -35.0, 0.2);
  EXPECT_EQ(timed.intervals.size(), 59999U);
}

TEST(SensorTimes, ByPulsesAreExact) {
  const Device device{.first_s = 1000.0, .drift_ppm = 0.0, .pulse_every = 100};
  const TimedRecording timed = time_by_pulses(device.record(20000, 3), kCounting, {1000.0, 1.0}, kWeek);
  EXPECT_LT(largest_error(timed.imu), 5e-9);  // nanoseconds of GpsTime, and the rounding of the mean rate
}

TEST(SensorTimes, ALostSampleWidensTheNextInterval) {
  record::PacketRecording recording = Device{.pulse_every = 100}.record(2000, 4);
  recording.packets.erase(recording.packets.begin() + 1030, recording.packets.begin() + 1033);
  const TimedRecording timed = time_by_pulses(recording, kCounting, {1000.0, 1.0}, kWeek);
  EXPECT_EQ(timed.report.lost, 3U);
  EXPECT_NEAR(timed.imu.samples[1030].dt, 0.04, 1e-9);
  EXPECT_LT(largest_error(timed.imu), 5e-9);
}

TEST(SensorTimes, TooFewPacketsAreRefused) {
  EXPECT_THROW(static_cast<void>(time_by_pulses(Device{.pulse_every = 10}.record(30, 5), kCounting, {1000.0, 0.1}, kWeek)),
               std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
