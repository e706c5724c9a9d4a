#include "coast/array/alignment.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>

#include "coast/array/resample.hpp"

namespace coast::array {
namespace {

constexpr double kDt = 0.01;

/// Random rotation, exactly band-limited: tones at frequencies that no window holds whole periods of.
class Tones {
 public:
  Tones(std::uint64_t seed, double lowest_hz, double highest_hz, double rms) {
    constexpr int kCount = 40;
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> frequency(lowest_hz, highest_hz), phase(0.0, 2.0 * std::numbers::pi);
    for (auto& axis : axes_)
      for (int i = 0; i < kCount; ++i)
        axis.push_back({2.0 * std::numbers::pi * frequency(engine), phase(engine), rms * std::sqrt(2.0 / kCount)});
  }

  /// Column n holds the rates at (n + 1/2) dt (1 - drift) - lag.
  [[nodiscard]] SensorSignals seen(std::size_t count, double lag_s, double drift = 0.0) const {
    SensorSignals sensor;
    sensor.values.setZero(kChannels, static_cast<Eigen::Index>(count));
    sensor.usable.assign(count, kAllUsable);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis)
      for (const Tone& tone : axes_[axis]) {
        const double step = tone.omega * kDt * (1.0 - drift);
        std::complex<double> z = std::polar(tone.amplitude, tone.phase + 0.5 * step - tone.omega * lag_s);
        const std::complex<double> turn = std::polar(1.0, step);
        for (Eigen::Index n = 0; n < sensor.values.cols(); ++n, z *= turn)
          sensor.values(static_cast<Eigen::Index>(axis), n) += z.real();
      }
    return sensor;
  }

  /// Sum over the samples of the squared derivative.
  [[nodiscard]] double squared_changes(std::size_t count) const {
    double sum = 0.0;
    for (const auto& axis : axes_)
      for (const Tone& tone : axis) sum += 0.5 * std::pow(tone.amplitude * tone.omega, 2);
    return sum * static_cast<double>(count);
  }

 private:
  struct Tone {
    double omega, phase, amplitude;
  };
  std::array<std::vector<Tone>, 3> axes_;
};

SensorSignals with_noise(SensorSignals sensor, double sigma, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  for (Eigen::Index n = 0; n < sensor.values.cols(); ++n)
    for (int axis = 0; axis < 3; ++axis) sensor.values(axis, n) += normal(engine);
  return sensor;
}

/// Standard deviations of a car's rates in rad/s up to 4 Hz, and of a MEMS gyro's noise at 100 Hz.
constexpr double kMotion = 0.15;
constexpr double kNoise = 0.003;

TEST(Alignment, FindsLagsOfAnySizeAndSign) {
  const Tones motion(1, 0.05, 4.0, kMotion);
  const SensorSignals reference = with_noise(motion.seen(6000, 0.0), kNoise, 1);
  for (const double lag : {0.0, 1e-4, -1e-3, 0.005, 0.0123, -0.02, 0.31415, -0.497}) {
    const LagEstimate found = find_lag(reference, with_noise(motion.seen(6000, lag), kNoise, 2), kDt, 0, 6000);
    ASSERT_TRUE(found.lag) << found.why_not;
    EXPECT_NEAR(found.lag->lag_s, lag, 5.0 * found.lag->sigma_s) << lag;
    EXPECT_LT(found.lag->sigma_s, 2e-5);  // 0.1 ms is five of them
    EXPECT_GT(found.lag->coherence, 0.9);
  }
}

/// A parabola through the three largest values of the correlation over whole samples, as is often done.
double parabola_lag(const SensorSignals& a, const SensorSignals& b) {
  const auto sum = [&](Eigen::Index lag) {
    const Eigen::Index n = a.values.cols() - 20;
    return (a.values.middleCols(10, n).array() * b.values.middleCols(10 + lag, n).array()).sum();
  };
  Eigen::Index best = 0;
  for (Eigen::Index lag = -5; lag <= 5; ++lag)
    if (sum(lag) > sum(best)) best = lag;
  const double left = sum(best - 1), centre = sum(best), right = sum(best + 1);
  return kDt * (static_cast<double>(best) + 0.5 * (left - right) / (left - 2.0 * centre + right));
}

// Without noise what is left is the method's own error: the ends of the window, of the order of a tone's leakage there.
TEST(Alignment, HasNoBiasFromInterpolationWhereAParabolaHas) {
  const Tones motion(2, 0.5, 25.0, kMotion);
  const SensorSignals reference = motion.seen(6000, 0.0);
  double worst = 0.0, parabola = 0.0;
  for (double lag = -0.005; lag <= 0.005; lag += 0.00125) {
    const SensorSignals sensor = motion.seen(6000, lag);
    const LagEstimate found = find_lag(reference, sensor, kDt, 0, 6000);
    ASSERT_TRUE(found.lag);
    worst = std::max(worst, std::abs(found.lag->lag_s - lag));
    parabola = std::max(parabola, std::abs(parabola_lag(reference, sensor) - lag));
  }
  RecordProperty("worst_us", std::to_string(1e6 * worst));
  RecordProperty("parabola_us", std::to_string(1e6 * parabola));
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(parabola, 1e-4);
}

// Deterministic motion in white noise of both sensors: the bound of any unbiased delay is
// (sigma_a^2 + sigma_b^2)/sum(s'^2) where the motion is far above the noise.
TEST(Alignment, ErrorsAreAsStatedAndNearTheCramerRaoBound) {
  for (const double noise : {0.003, 0.03}) {
    double squares = 0.0, normalised = 0.0, bound = 0.0;
    const int runs = 150;
    for (int run = 0; run < runs; ++run) {
      const auto seed = 1000 + 10 * static_cast<std::uint64_t>(run);
      const Tones motion(seed, 0.05, 4.0, kMotion);
      const double lag = 0.0033 + 1e-4 * run;
      const LagEstimate found =
          find_lag(with_noise(motion.seen(3200, 0.0), noise, seed + 1),
                   with_noise(motion.seen(3200, lag), 2.0 * noise, seed + 2), kDt, 0, 3200, {.max_lag_s = 0.1});
      ASSERT_TRUE(found.lag) << found.why_not;
      const double error = found.lag->lag_s - lag;
      squares += error * error;
      normalised += std::pow(error / found.lag->sigma_s, 2);
      bound += 5.0 * noise * noise / motion.squared_changes(3200 - 22);  // 11 samples at both ends are the search's
    }
    // Chi-square of 150: its mean within 1 -+ 4 sqrt(2/150) = 0.46. Beyond that 10 % for sigmas from estimated coherences.
    EXPECT_GT(normalised / runs, 0.5) << noise;
    EXPECT_LT(normalised / runs, 1.6) << noise;
    // The taper costs 1.12 of variance; the bound is passed by chance only.
    EXPECT_GT(squares / bound, 0.6) << noise;
    EXPECT_LT(squares / bound, 1.8) << noise;
    RecordProperty(noise < 0.01 ? "over_bound_high" : "over_bound_low", std::to_string(squares / bound));
    RecordProperty(noise < 0.01 ? "over_stated_high" : "over_stated_low", std::to_string(normalised / runs));
  }
}

TEST(Alignment, WithoutMotionThereIsNoLag) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const SensorSignals still = Tones(1, 0.05, 4.0, 0.0).seen(6000, 0.0);
    const LagEstimate estimate =
        find_lag(with_noise(still, kNoise, 2 * seed), with_noise(still, kNoise, 2 * seed + 1), kDt, 0, 6000);
    found += estimate.lag ? 1 : 0;
    EXPECT_EQ(estimate.lag.has_value(), estimate.why_not.empty());
  }
  EXPECT_EQ(found, 0);  // six sigmas of about 270 bands: 1e-7 each, were it not for the choice of the whole lag
  const LagEstimate beyond =
      find_lag(Tones(3, 0.05, 4.0, kMotion).seen(6000, 0.0), Tones(3, 0.05, 4.0, kMotion).seen(6000, 0.0), kDt, 0, 150);
  EXPECT_FALSE(beyond.lag);
  EXPECT_NE(beyond.why_not.find("too few"), std::string::npos);
}

/// Twenty minutes in which the tags gain.
TEST(Alignment, LagsOverWindowsGiveOffsetAndDrift) {
  const Tones motion(5, 0.05, 4.0, kMotion);
  const std::size_t count = 120000;
  for (const double drift : {1e-6, -20e-6, 100e-6}) {
    const double offset = 0.004;  // at zero; tag t means t (1 - drift) - offset
    SensorSignals sensor = with_noise(motion.seen(count, offset, drift), kNoise, 8);
    const SensorSignals reference = with_noise(motion.seen(count, 0.0), kNoise, 9);
    for (std::size_t n = 30000; n < 30500; ++n) sensor.usable[n] &= 0x3E;  // one rate is missing for 5 s
    const std::optional<LagCurve> curve = lag_curve(reference, sensor, kDt);
    ASSERT_TRUE(curve);
    EXPECT_EQ(curve->windows.size(), 19u);  // 5 and 14
    EXPECT_NEAR(curve->drift_ppm, 1e6 * drift, 5.0 * curve->drift_sigma_ppm);
    EXPECT_NEAR(curve->offset_s, offset + drift * curve->reference_s, 5.0 * curve->offset_sigma_s);
    // 20 us a window over 19 windows; at 100 ppm the centres of motion, known to 0.5 s, add 50 us a window.
    EXPECT_LT(curve->drift_sigma_ppm, 0.05);
    EXPECT_LT(curve->offset_sigma_s, 2e-5);
    EXPECT_LT(curve->scatter, 2.5);
  }
}

// All motion in the last fifth of each window: with 100 ppm the lag there is 2.4 ms from that of its middle.
TEST(Alignment, TheLagBelongsToWhereTheMotionIs) {
  const Tones motion(6, 0.05, 4.0, kMotion);
  const std::size_t count = 36000;
  const double drift = 100e-6;
  SensorSignals reference = motion.seen(count, 0.0), sensor = motion.seen(count, 0.0, drift);
  for (std::size_t n = 0; n < count; ++n) {
    const double phase = std::fmod(static_cast<double>(n) * kDt, 60.0) - 48.0;
    const double hill = std::exp(-0.5 * phase * phase / 9.0);  // motion of 3 s
    reference.values.col(static_cast<Eigen::Index>(n)) *= hill;
    sensor.values.col(static_cast<Eigen::Index>(n)) *= hill;
  }
  const std::optional<LagCurve> curve = lag_curve(with_noise(reference, kNoise, 1), with_noise(sensor, kNoise, 2), kDt);
  ASSERT_TRUE(curve);
  // The hill itself is not delayed here: 2 (hill's slope)^2 against the motion's, below 1e-3 of lags up to 36 ms.
  EXPECT_NEAR(curve->at(0.0), 0.0, 5e-5 + 5.0 * std::hypot(curve->offset_sigma_s, 180.0 * 1e-6 * curve->drift_sigma_ppm));
  EXPECT_NEAR(curve->windows[0].at_s, 48.0, 1.0);
}

TEST(Alignment, AWrongWindowDoesNotBendTheLine) {
  const Tones motion(7, 0.05, 4.0, kMotion);
  const std::size_t count = 60000;
  SensorSignals sensor = with_noise(motion.seen(count, 0.002), kNoise, 3);
  const SensorSignals late = with_noise(motion.seen(count, 0.052), kNoise, 3);
  sensor.values.middleCols(48000, 6000) = late.values.middleCols(48000, 6000);  // stalled for a minute
  const std::optional<LagCurve> curve = lag_curve(with_noise(motion.seen(count, 0.0), kNoise, 4), sensor, kDt);
  ASSERT_TRUE(curve);
  EXPECT_LT(curve->weights[8], 0.01);
  EXPECT_NEAR(curve->offset_s, 0.002, 5.0 * curve->offset_sigma_s);
  EXPECT_NEAR(curve->drift_ppm, 0.0, 5.0 * curve->drift_sigma_ppm);
}

/// The sensor's samples as recorded, each tagged with the end of its interval.
record::ImuRecording as_recorded(const SensorSignals& sensor) {
  record::ImuRecording recording;
  for (Eigen::Index n = 0; n < sensor.values.cols(); ++n) {
    record::ImuSample sample;
    sample.t = geo::GpsTime() + kDt * static_cast<double>(n + 1);
    sample.dt = kDt;
    sample.dtheta = kDt * sensor.values.col(n).head<3>();
    sample.dv = kDt * sensor.values.col(n).tail<3>();
    recording.samples.push_back(sample);
  }
  return recording;
}

// Found on tags as they are, taken out on resampling: what is left is nothing. A wrong sign would leave twice as much.
TEST(Alignment, ALagTakenOutIsGone) {
  const Tones motion(9, 0.05, 4.0, kMotion);
  const Grid grid{geo::GpsTime() + 1.0, kDt, 59800};
  const SensorSignals reference = resample(as_recorded(with_noise(motion.seen(60000, 0.0), kNoise, 1)), grid);
  const auto sensor = as_recorded(with_noise(motion.seen(60000, 0.0073, 50e-6), kNoise, 2));
  LinearLag lag{grid.start, 0.0, 0.0};
  for (int pass = 0; pass < 2; ++pass) {
    const std::optional<LagCurve> curve = lag_curve(reference, resample(sensor, grid, lag), kDt);
    ASSERT_TRUE(curve);
    lag.offset_s += curve->at(0.0);
    lag.drift_ppm += curve->drift_ppm;
  }
  // 600 s at 20 us a minute: 6 us in the middle and 0.05 ppm; at the start of the grid twice as much.
  EXPECT_NEAR(lag.offset_s, 0.0073 + 50e-6 * 1.0, 6e-5);
  EXPECT_NEAR(lag.drift_ppm, 50.0, 0.2);
  const std::optional<LagCurve> left = lag_curve(reference, resample(sensor, grid, lag), kDt);
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->offset_s, 0.0, 5e-6);  // the last step of the passes, not the error
  EXPECT_NEAR(left->drift_ppm, 0.0, 0.05);
  EXPECT_LT(left->scatter, 2.0);
}

// Sensors whose axes are not the same: by the norm.
TEST(Alignment, NormsNeedNoOrientation) {
  const Tones motion(8, 0.05, 4.0, kMotion);
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  SensorSignals reference = with_noise(motion.seen(6000, 0.0), kNoise, 5), sensor = motion.seen(6000, 0.0123);
  sensor.values.topRows<3>() = (turned * sensor.values.topRows<3>()).eval();
  sensor = with_noise(sensor, kNoise, 6);
  const LagEstimate found = find_lag(reference, sensor, kDt, 0, 6000, {.of = LagSignal::kNorm});
  ASSERT_TRUE(found.lag) << found.why_not;
  EXPECT_NEAR(found.lag->lag_s, 0.0123, 5.0 * found.lag->sigma_s);
  EXPECT_LT(found.lag->sigma_s, 3e-5);
}

TEST(Alignment, RefusesWhatIsOutOfRange) {
  const SensorSignals some = Tones(1, 0.05, 4.0, kMotion).seen(1000, 0.0);
  EXPECT_THROW((void)find_lag(some, Tones(1, 0.05, 4.0, kMotion).seen(999, 0.0), kDt, 0, 900), std::invalid_argument);
  EXPECT_THROW((void)find_lag(some, some, 0.0, 0, 1000), std::invalid_argument);
  EXPECT_THROW((void)find_lag(some, some, kDt, 500, 501), std::invalid_argument);
  EXPECT_THROW((void)find_lag(some, some, kDt, 0, 1000, {.max_lag_s = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)lag_curve(some, some, kDt, {.window_s = 0.0}), std::invalid_argument);
  EXPECT_FALSE(lag_curve(some, some, kDt));  // shorter than one window
}

}  // namespace
}  // namespace coast::array
