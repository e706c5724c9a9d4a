#include "coast/array/resample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace coast::array {
namespace {

/// Sums of sines on a constant, with their integrals in closed form. Channel c has amplitude c + 1.
struct Wave {
  struct Tone {
    double frequency, phase;
  };
  std::vector<Tone> tones;
  double constant = 0.0;

  [[nodiscard]] double mean(double from, double to) const {
    double sum = constant;
    for (const Tone& tone : tones) {
      const double omega = 2.0 * std::numbers::pi * tone.frequency;
      // sin(a) - sin(b) as a product: no cancellation over a short interval.
      const double half = 0.5 * omega * (to - from);
      sum += std::cos(omega * 0.5 * (from + to) + tone.phase) * std::sin(half) / half;
    }
    return sum;
  }
};

const geo::GpsTime kStart = geo::GpsTime::from_week(2300, 345600.0);

/// Increments between true instants; tags carry them plus a lag.
record::ImuRecording recorded(const Wave& wave, const std::vector<double>& instants,
                              const std::function<double(double)>& tag_of) {
  record::ImuRecording recording;
  recording.source = "wave";
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const double from = instants[i - 1], to = instants[i];
    record::ImuSample sample;
    sample.t = kStart + tag_of(to);
    sample.dt = tag_of(to) - tag_of(from);
    const double mean = wave.mean(from, to) * (to - from);
    sample.dtheta = mean * Eigen::Vector3d(1, 2, 3);
    sample.dv = mean * Eigen::Vector3d(4, 5, 6);
    recording.samples.push_back(sample);
  }
  return recording;
}

std::vector<double> even(double from, double interval, int count) {
  std::vector<double> instants;
  for (int i = 0; i <= count; ++i) instants.push_back(from + interval * i);
  return instants;
}

double as_it_is(double t) {
  return t;
}

/// Largest error over the usable columns, by channel amplitude; how many they are.
struct Worst {
  double error = 0.0;
  std::size_t usable = 0;
};
Worst worst_error(const SensorSignals& signals, const Grid& grid, const Wave& wave) {
  Worst worst;
  for (std::size_t n = 0; n < grid.samples; ++n) {
    if (signals.usable[n] != kAllUsable) continue;
    ++worst.usable;
    const double from = (grid.start - kStart) + grid.dt * static_cast<double>(n);
    const double expected = wave.mean(from, from + grid.dt);
    for (int c = 0; c < kChannels; ++c)
      worst.error = std::max(worst.error, std::abs(signals.values(c, static_cast<Eigen::Index>(n)) / (c + 1) - expected));
  }
  return worst;
}

// 32 taps, Kaiser: 97 dB is 1.4e-5 of a single edge of the band, and the images of two add up. Asked for: 1e-4.
TEST(Resample, SinesUpToEightTenthsOfNyquist) {
  double worst = 0.0;
  for (const double input : {0.01, 0.008, 0.005, 0.02}) {
    const double highest = 0.4 / std::max(input, 0.01);
    for (const double share : {1e-3, 0.1, 0.8, 1.0}) {
      const Wave wave{{{share * highest, 0.7}}, 0.0};
      const Grid grid{kStart + 1.00371, 0.01, 1500};
      const SensorSignals signals = resample(recorded(wave, even(0.0, input, static_cast<int>(20.0 / input)), as_it_is), grid);
      const Worst at = worst_error(signals, grid, wave);
      EXPECT_EQ(at.usable, 1500u);
      EXPECT_LT(at.error, 3e-5) << input << " " << share;
      worst = std::max(worst, at.error);
    }
  }
  RecordProperty("worst", std::to_string(1e6 * worst) + "e-6");
}

TEST(Resample, AConstantIsExactAndAnglesAddUp) {
  const Wave wave{{{0.3, 0.2}, {7.0, 1.0}}, 9.8};
  const Grid grid{kStart + 1.0, 0.013, 1000};
  const auto recording = recorded(wave, even(0.0, 0.01, 2000), as_it_is);
  const SensorSignals signals = resample(recording, grid);
  // Sum over 13 s: the error of the tones' sum, 1e-5 of each period's, not growing with time.
  EXPECT_NEAR(signals.values.row(0).sum() * grid.dt, wave.mean(1.0, 14.0) * 13.0, 1e-5);
  const Wave constant{{}, 9.8};
  EXPECT_LT(worst_error(resample(recorded(constant, even(0.0, 0.01, 2000), as_it_is), grid), grid, constant).error,
            9.8 * 1e-8);  // tags and intervals are rounded to 1 ns, 1e-7 of an interval, and 32 taps take their mean
}

// Flat spectrum up to 0.4 of the sampling frequency, 40 tones: errors of tones at random phases.
TEST(Resample, RandomBandLimitedSignals) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> frequency(0.0, 40.0), phase(0.0, 2.0 * std::numbers::pi);
  Wave wave;
  for (int i = 0; i < 40; ++i) wave.tones.push_back({frequency(engine), phase(engine)});
  const Grid grid{kStart + 2.0037, 0.01, 1500};
  const SensorSignals signals = resample(recorded(wave, even(0.0, 0.01, 2000), as_it_is), grid);
  EXPECT_LT(worst_error(signals, grid, wave).error, 40.0 * 1e-5);
}

// 200 Hz onto 20 Hz: what the grid cannot hold is damped, what it can stays.
TEST(Resample, ACoarserGridIsProtectedFromWhatItCannotHold) {
  for (const double above : {12.0, 13.3, 20.0, 37.0, 80.0}) {  // from 0.6 of 20 Hz
    const Wave wave{{{above, 0.3}}, 0.0};
    const Grid grid{kStart + 3.0, 0.05, 200};
    const SensorSignals signals = resample(recorded(wave, even(0.0, 0.005, 4000), as_it_is), grid);
    EXPECT_LT(signals.values.row(0).cwiseAbs().maxCoeff(), 3e-5) << above;
  }
  const Wave wave{{{8.0, 0.3}}, 0.0};
  const Grid grid{kStart + 3.0, 0.05, 200};
  EXPECT_LT(worst_error(resample(recorded(wave, even(0.0, 0.005, 4000), as_it_is), grid), grid, wave).error, 3e-5);
}

// Tags late by 12.3 ms at 10 s and gaining 100 ppm: t_tag = t + lag(t_tag).
TEST(Resample, LagAndDriftAreTakenOut) {
  const LinearLag lag{kStart + 10.0, 0.0123, 100.0};
  const auto tag_of = [](double t) { return (t + 0.0123 - 10.0 * 100e-6) / (1.0 - 100e-6); };
  const Wave wave{{{20.0, 0.3}, {0.7, 1.0}}, 0.5};
  const Grid grid{kStart + 1.0, 0.01, 1700};
  const auto recording = recorded(wave, even(0.001, 0.01 * (1.0 - 100e-6), 2000), tag_of);
  // Tags are rounded to 1 ns: 2 pi 20 Hz of that is 1e-7.
  EXPECT_LT(worst_error(resample(recording, grid, lag), grid, wave).error, 4e-5);
  EXPECT_GT(worst_error(resample(recording, grid), grid, wave).error, 0.5);  // the wrong sign or none would be seen
}

// A clock that bends: 100 ppm to and fro within 100 s. Followed, as its intervals are.
TEST(Resample, AWanderingClockIsFollowed) {
  const auto wander = [](double t) {
    return 100e-6 * 100.0 / (2.0 * std::numbers::pi) * std::sin(2.0 * std::numbers::pi * t / 100.0);
  };
  std::vector<double> instants = even(0.0, 0.01, 20000);
  for (double& t : instants) t += wander(t);
  const Wave wave{{{30.0, 0.3}}, 0.0};
  const Grid grid{kStart + 1.0, 0.01, 19000};
  // Width of the kernel's means: 100 ppm of it at 0.3 of the sampling frequency is 5e-5 at most.
  EXPECT_LT(worst_error(resample(recorded(wave, instants, as_it_is), grid), grid, wave).error, 6e-5);
}

TEST(Resample, JitteringTagsAreBelieved) {
  struct Expectation {
    double frequency, error;
  };
  // The polynomial of degree six: its error grows with the sixth power of the frequency. Twice
  // what the header states, which is the largest of 3800 errors of one random record.
  for (const auto& [frequency, most] : {Expectation{1.0, 1e-5}, {5.0, 1e-5}, {10.0, 1.5e-4}, {20.0, 8e-3}, {40.0, 0.12}}) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> jitter(0.0, 3e-4);
    std::vector<double> instants = even(0.0, 0.01, 4000);
    for (double& t : instants) t += jitter(engine);
    const Wave wave{{{frequency, 0.3}}, 1.0};
    const Grid grid{kStart + 1.0037, 0.01, 3800};
    const Worst worst = worst_error(resample(recorded(wave, instants, as_it_is), grid), grid, wave);
    EXPECT_LT(worst.error, most) << frequency;
    RecordProperty("at_" + std::to_string(static_cast<int>(frequency)) + "_hz", std::to_string(1e6 * worst.error) + "e-6");
  }
}

TEST(Resample, GapsAndTheFiltersReachAreNotUsable) {
  const Wave wave{{{3.0, 0.3}}, 1.0};
  auto recording = recorded(wave, even(0.0, 0.01, 1000), as_it_is);
  recording.samples.erase(recording.samples.begin() + 500, recording.samples.begin() + 501);  // (5.00, 5.01]
  recording.samples.erase(recording.samples.begin() + 700, recording.samples.begin() + 750);  // (7.01, 7.51]
  const Grid grid{kStart, 0.01, 1000};
  const SensorSignals signals = resample(recording, grid);
  // On the same grid the centre is a sample: 16 to both sides, the outermost included.
  for (std::size_t n = 0; n < 1000; ++n) {
    const bool near = n < 16 || (n + 16 >= 500 && n <= 516) || (n + 16 >= 701 && n <= 750 + 16) || n + 16 >= 1000;
    EXPECT_EQ(signals.usable[n], near ? 0 : kAllUsable) << n;
  }
  EXPECT_EQ(worst_error(signals, grid, wave).usable, 1000u - 32u - 33u - 82u);
  EXPECT_LT(worst_error(signals, grid, wave).error, 3e-5);
  EXPECT_EQ(signals.values.col(720).norm(), 0.0);
  EXPECT_NEAR(signals.values(0, 499), wave.mean(4.99, 5.0), 0.1);  // from the taps that are there
}

// A sample whose interval was stretched over the lost ones tells their sum at best.
TEST(Resample, ALongIntervalIsAGap) {
  const Wave wave{{{3.0, 0.3}}, 1.0};
  auto recording = recorded(wave, even(0.0, 0.01, 1000), as_it_is);
  auto stretched = recording;
  recording.samples.erase(recording.samples.begin() + 500, recording.samples.begin() + 503);
  stretched.samples.erase(stretched.samples.begin() + 500, stretched.samples.begin() + 502);
  stretched.samples[500].dt = 0.03;
  const Grid grid{kStart, 0.01, 1000};
  EXPECT_EQ(resample(stretched, grid).usable, resample(recording, grid).usable);
  EXPECT_EQ(resample(stretched, grid).values, resample(recording, grid).values);
}

TEST(Resample, NothingOutsideTheRecordingIsUsable) {
  const Wave wave{{}, 1.0};
  const auto recording = recorded(wave, even(0.0, 0.01, 500), as_it_is);
  const Grid after{kStart + 60.0, 0.01, 100}, before{kStart - 60.0, 0.01, 100};
  for (const Grid& grid : {after, before})
    for (const std::uint8_t usable : resample(recording, grid).usable) EXPECT_EQ(usable, 0);
}

TEST(Resample, RefusesWhatIsOutOfRange) {
  const auto recording = recorded({{}, 1.0}, even(0.0, 0.01, 500), as_it_is);
  EXPECT_THROW((void)resample(record::ImuRecording{}, {kStart, 0.01, 10}), std::invalid_argument);
  EXPECT_THROW((void)resample(recording, {kStart, 0.0, 10}), std::invalid_argument);
  EXPECT_THROW((void)resample(recording, {kStart, 11.0, 10}), std::invalid_argument);
  EXPECT_THROW((void)resample(recording, {kStart, 0.01, 10}, LinearLag{kStart, 0.0, 2e6}), std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
