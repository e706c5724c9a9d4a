#include "coast/array/clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

namespace coast::array {
namespace {

constexpr double kInterval = 0.01;

/// Positive, jittering, heavy-tailed: 1 ms that all share, an exponential of 2 ms, and every hundredth packet a Pareto tail of
/// 5 ms and more (infinite variance).
class Delays {
 public:
  explicit Delays(std::uint64_t seed, double shared_s = 0.001) : engine_(seed), shared_(shared_s) {}
  double operator()() {
    const double base = shared_ + exponential_(engine_);
    return uniform_(engine_) < 0.01 ? base + 0.005 * std::pow(1.0 - uniform_(engine_), -1.0 / 1.5) : base;
  }
  /// What the given share of packets is below; the tail's share counts as slower than that.
  [[nodiscard]] double quantile(double q) const { return shared_ - 0.002 * std::log(1.0 - q / 0.99); }

 private:
  std::mt19937_64 engine_;
  double shared_;
  std::exponential_distribution<double> exponential_{1.0 / 0.002};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

/// A device whose sample n is taken at `time_of(n interval)` of GPS time and seen by a computer ahead by 7 s and 30 ppm.
double computer_time(double gps_s) {
  return gps_s + 7.0 + 30e-6 * (gps_s - 300000.0);
}

PacketSegment device(std::int64_t first, int count, const std::function<double(double)>& time_of, Delays delays) {
  PacketSegment segment;
  for (int i = 0; i < count; ++i) {
    Packet packet;
    packet.counter = first + i;
    packet.arrival_s = computer_time(time_of(static_cast<double>(packet.counter) * kInterval)) + delays();
    segment.packets.push_back(packet);
  }
  return segment;
}

PacketSegment master(int count, Delays delays) {
  PacketSegment segment = device(
      0, count, [](double t) { return 300000.0 + t; }, delays);
  for (Packet& packet : segment.packets) packet.master_s = 300000.0 + static_cast<double>(packet.counter) * kInterval;
  return segment;
}

struct Truth {
  double offset_s;
  double drift_ppm;
};
class EveryClock : public testing::TestWithParam<Truth> {};
INSTANTIATE_TEST_SUITE_P(Clock, EveryClock,
                         testing::Values(Truth{0.1e-3, 1.0}, Truth{1e-3, -10.0}, Truth{5e-3, 30.0}, Truth{20e-3, -100.0},
                                         Truth{-20e-3, 100.0}));

// Ten minutes at 100 Hz. Master and device have delays alike, so what they share falls out.
TEST_P(EveryClock, SoftwareModeFindsOffsetAndDriftThroughJitter) {
  const double offset = GetParam().offset_s, drift = GetParam().drift_ppm;
  const auto time_of = [&](double t) { return 300000.0 + t + offset + 1e-6 * drift * (t - 300.0); };
  const ClockFit computer = computer_clock(master(60000, Delays(1)));
  const ClockFit fit = software_clock(device(0, 60000, time_of, Delays(2)), kInterval, computer);
  // The stated sigmas are 4 us and 0.02 ppm for the two clocks together: five of them, far below the 0.1 ms asked for.
  const double at = fit.reference_s, offset_at = time_of(at) - at;
  EXPECT_NEAR(fit.offset_s, offset_at, 5.0 * std::hypot(fit.offset_sigma_s, computer.offset_sigma_s));
  EXPECT_NEAR(fit.drift_ppm, drift, 5.0 * std::hypot(fit.drift_sigma_ppm, computer.drift_sigma_ppm));
  EXPECT_LT(fit.offset_sigma_s, 5e-6);
  EXPECT_LT(fit.drift_sigma_ppm, 0.03);
  double worst = 0.0;
  for (double t = 0.0; t < 600.0; t += 1.0) worst = std::max(worst, std::abs(fit.curve.time(t) - time_of(t)));
  EXPECT_LT(worst, 1e-4);
}

// The spread of estimates over records against what each of them states.
TEST(Clock, StatedErrorsAreThoseOfManyRecords) {
  double offset = 0.0, drift = 0.0, quantile = 0.0;
  const int runs = 60;
  for (int run = 0; run < runs; ++run) {
    Delays delays(static_cast<std::uint64_t>(100 + run));
    std::vector<double> sent, arrived;
    for (int i = 0; i < 15000; ++i) {
      sent.push_back(kInterval * i);
      arrived.push_back(sent.back() * (1.0 + 20e-6) + delays());
    }
    const ClockFit fit = fit_clock(sent, arrived);
    const double error = fit.offset_s - 20e-6 * fit.reference_s - delays.quantile(0.05);
    offset += std::pow(error / fit.offset_sigma_s, 2);
    drift += std::pow((fit.drift_ppm - 20.0) / fit.drift_sigma_ppm, 2);
    quantile += fit.residuals.minimum;
  }
  // Chi-square of 60: a factor of (1 +- 4 sqrt(2/60)), and 1.15 for sigmas that are themselves estimated from 30 blocks.
  EXPECT_GT(offset / runs, 0.35);
  EXPECT_LT(offset / runs, 2.0);
  EXPECT_GT(drift / runs, 0.35);
  EXPECT_LT(drift / runs, 2.0);
  // The fastest of 15000 is 0.2 us above the shared delay; the curve is its quantile above.
  EXPECT_NEAR(quantile / runs, 0.001 - Delays(0).quantile(0.05), 1e-5);
}

// Warming up: 30 ppm that fade with 10 minutes. Broken lines of 60 s against a curve: 60^2/8 of its second derivative of
// 30e-6/600 per s is 22 us.
TEST(Clock, FollowsAWarmingClock) {
  const auto time_of = [](double t) { return t + 0.003 - 30e-6 * 600.0 * (1.0 - std::exp(-t / 600.0)); };
  std::vector<double> sent, arrived;
  Delays delays(3);
  for (int i = 0; i < 120000; ++i) {
    sent.push_back(kInterval * i);
    arrived.push_back(time_of(sent.back()) + delays());
  }
  const ClockFit fit = fit_clock(sent, arrived);
  const double shared = delays.quantile(0.05);
  EXPECT_GT(fit.curve.knots().size(), 15u);
  double worst = 0.0;
  for (const ClockCurve::Knot& knot : fit.curve.knots()) EXPECT_LT(knot.sigma_s, 2e-5);
  for (double t = 0.0; t < 1200.0; t += 1.0) worst = std::max(worst, std::abs(fit.curve.time(t) - shared - time_of(t)));
  EXPECT_LT(worst, 22e-6 + 4.0 * 2e-5);
  // A straight line would be off by far more.
  EXPECT_GT(std::abs(fit.offset_s + fit.drift_ppm * 1e-6 * (0.0 - fit.reference_s) - 0.003 - shared), 5e-4);
}

// Half a minute during which nothing comes in time, and packets with times before they were sent.
TEST(Clock, IsNotMovedByAHangingComputerOrByWrongStamps) {
  std::vector<double> sent, arrived;
  Delays delays(4);
  for (int i = 0; i < 60000; ++i) {
    sent.push_back(kInterval * i);
    arrived.push_back(sent.back() + delays());
    if (i > 40000 && i < 43000) arrived.back() += 0.02;
    if (i % 997 == 0) arrived.back() -= 0.5;
  }
  const ClockFit fit = fit_clock(sent, arrived);
  // A thousandth of wrong stamps shifts the five per cent quantile by 2 us.
  EXPECT_NEAR(fit.offset_s, delays.quantile(0.05), 2e-6 + 5.0 * fit.offset_sigma_s);
  EXPECT_NEAR(fit.drift_ppm, 0.0, 5.0 * fit.drift_sigma_ppm);
  EXPECT_LT(fit.drift_sigma_ppm, 0.05);
}

/// Hardware synchronisation: each second the sample is taken with the pulse, between them the device's own clock runs.
PacketSegment pulsed(double drift_ppm) {
  PacketSegment segment;
  double time = 1000.0;
  std::int64_t counter = 5'000'000;
  for (int second = 0; second < 600; ++second)
    for (int i = 0; i < 100; ++i, ++counter) {
      Packet packet;
      packet.counter = counter;
      packet.arrival_s = time + 0.002;
      if (i == 0) packet.pulse = second;
      segment.packets.push_back(packet);
      time += kInterval * (1.0 + 1e-6 * drift_ppm);
    }
  return segment;
}

TEST(Clock, PulsesGiveTheTimeOfEverySampleBetweenThem) {
  for (const double drift : {0.0, 1.0, -100.0}) {
    const double period = 1.0 + 1e-6 * drift;  // the device's second in GPS time: an even device, exactly linear
    const PacketSegment segment = pulsed(drift);
    const ClockFit fit = pulse_clock(segment, kInterval, {.first_s = 1000.0, .period_s = period});
    for (std::size_t i = 0; i < segment.packets.size(); i += 37) {
      const Packet& packet = segment.packets[i];
      // Rounding: 6e4 intervals summed up in the simulation, 1e-13 each. 1e-11 of the times themselves.
      EXPECT_NEAR(fit.curve.time(static_cast<double>(packet.counter) * kInterval), packet.arrival_s - 0.002, 1e-8);
    }
    EXPECT_NEAR(fit.drift_ppm, drift, 1e-6);
    EXPECT_EQ(fit.rejected, 0u);
    EXPECT_LT(fit.residuals.maximum, 1e-9);
  }
}

TEST(Clock, LostAndMisplacedPulsesDoNotMatter) {
  PacketSegment segment = pulsed(20.0);
  const PulseTrain train{.first_s = 1000.0, .period_s = 1.0 + 20e-6};
  for (const std::size_t second : {3U, 77U, 78U, 79U, 300U}) segment.packets[100 * second].pulse.reset();
  for (const std::size_t second : {0U, 150U, 599U}) {  // one sample late
    segment.packets[100 * second].pulse.reset();
    segment.packets[100 * second + 1].pulse = static_cast<std::int64_t>(second);
  }
  const ClockFit fit = pulse_clock(segment, kInterval, train);
  EXPECT_EQ(fit.rejected, 3u);
  for (const Packet& packet : segment.packets)
    EXPECT_NEAR(fit.curve.time(static_cast<double>(packet.counter) * kInterval), packet.arrival_s - 0.002, 1e-8);
}

// As the paper's Fig. 8: arrivals jitter by milliseconds, samples do not.
TEST(Clock, SamplingIntervalsJitterInArrivalOnly) {
  PacketSegment segment = device(
      0, 60000, [](double t) { return 300000.0 + t; }, Delays(5));
  segment.packets.erase(segment.packets.begin() + 100, segment.packets.begin() + 110);
  const ClockFit computer = computer_clock(master(60000, Delays(6)));
  const ClockFit fit = software_clock(segment, kInterval, computer);
  const std::vector<SamplingInterval> intervals = sampling_intervals(segment, kInterval, fit);
  ASSERT_EQ(intervals.size(), 60000u - 10u - 2u);  // none over the loss
  double arrived = 0.0, corrected = 0.0;
  for (const SamplingInterval& interval : intervals) {
    arrived += std::pow(interval.arrival_s - kInterval, 2);
    corrected = std::max(corrected, std::abs(interval.corrected_s - kInterval));
  }
  EXPECT_GT(std::sqrt(arrived / 6e4), 2e-3);  // two exponentials of 2 ms: 2.8 ms, and the tail
  EXPECT_LT(corrected, 1e-7);                 // 1 ppm of drift is 1e-8
}

TEST(Clock, CurveInvertsItself) {
  const ClockCurve curve({{0.0, 5.0, 0.0}, {60.0, 5.001, 0.0}, {120.0, 4.99, 0.0}, {200.0, 5.2, 0.0}});
  for (double t = -50.0; t < 300.0; t += 3.7) EXPECT_NEAR(curve.device(curve.time(t)), t, 1e-12 * 300.0);
  EXPECT_NEAR(curve.time(90.0), 90.0 + 4.9955, 1e-13);
  EXPECT_NEAR(curve.time(-60.0), -60.0 + 4.999, 1e-12);
}

TEST(Clock, RefusesWhatIsOutOfRange) {
  std::vector<double> t;
  for (int i = 0; i < 100; ++i) t.push_back(0.01 * i);
  EXPECT_NO_THROW((void)fit_clock(t, t));
  EXPECT_THROW((void)fit_clock({t.begin(), t.begin() + 59}, {t.begin(), t.begin() + 59}), std::invalid_argument);
  EXPECT_THROW((void)fit_clock({t.begin(), t.begin() + 70}, t), std::invalid_argument);
  EXPECT_THROW((void)fit_clock(t, t, {.quantile = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)fit_clock(t, t, {.block_s = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)fit_clock(std::vector<double>(100, 1.0), t), std::invalid_argument);
  EXPECT_THROW((void)pulse_clock(PacketSegment{}, kInterval, {}), std::invalid_argument);
  EXPECT_THROW((void)pulse_clock(pulsed(0.0), 0.0, {}), std::invalid_argument);
  EXPECT_THROW((void)pulse_clock(pulsed(0.0), kInterval, {.period_s = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)sampling_intervals(PacketSegment{}, -1.0, {}), std::invalid_argument);
  EXPECT_THROW(ClockCurve({{0.0, 0.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(ClockCurve({{0.0, 0.0, 0.0}, {1.0, -2.0, 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
