#include "coast/array/defects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "coast/array/defect_study.hpp"
#include "parity_noise.hpp"
#include "parity_thresholds.hpp"

namespace coast::array {
namespace {

/// White noise of known strengths about a common motion, written without the room's own simulation.
Signals plain_array(const std::vector<double>& sd, std::size_t samples, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Signals signals;
  signals.dt = 0.01;
  for (std::size_t k = 0; k < sd.size(); ++k) {
    SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.usable.assign(samples, kAllUsable);
    sensor.values.resize(kChannels, static_cast<Eigen::Index>(samples));
    for (Eigen::Index n = 0; n < sensor.values.cols(); ++n)
      for (int c = 0; c < kChannels; ++c)
        sensor.values(c, n) = std::sin(0.013 * static_cast<double>(n) + c) + 0.1 * static_cast<double>(k) -
                              (c == 5 ? 9.8 : 0.0) + sd[k] * normal(random);
  }
  return signals;
}

const Defect* defect_in(const DefectReport& report, std::size_t sensor, int channel, std::size_t from, std::size_t to) {
  for (const Defect& defect : report.defects)
    if (defect.sensor == sensor && ((defect.channels >> channel) & 1) != 0 && defect.found >= from && defect.found < to)
      return &defect;
  return nullptr;
}

DefectReport with_injection(const Injection& injection, std::uint64_t seed, std::size_t sensors = 4) {
  ArraySimulation simulation;
  simulation.sensors = sensors;
  Signals signals = simulate_array(simulation, seed);
  inject(signals, injection, seed);
  return find_defects(signals);
}

TEST(ParityNoise, SolvesTheVariancesOfTheResiduals) {
  // var r_k = sigma_k^2 (1 - 1/K)^2 + sum over the others sigma_j^2/K^2, from r = (I - 11'/K) z: a dense product.
  const Eigen::VectorXd own = (Eigen::VectorXd(5) << 1.0, 4.0, 0.3, 2.0, 0.7).finished();
  const Eigen::MatrixXd projector = Eigen::MatrixXd::Identity(5, 5) - Eigen::MatrixXd::Constant(5, 5, 0.2);
  const Eigen::VectorXd of_residuals = (projector * own.asDiagonal() * projector.transpose()).diagonal();
  EXPECT_NEAR((own_variances(of_residuals) - own).norm(), 0.0, 1e-13);  // rounding
}

TEST(ParityThresholds, NormalMaximaOverWindowsHaveTheStatedRate) {
  // Moving averages of W white values, 3e6 of them: exceedances in clumps (parted by W) against the rate they were meant for.
  for (const std::size_t window : {std::size_t{1}, std::size_t{10}, std::size_t{100}}) {
    const double per_hour = 0.3, step = 0.1;  // one in 12000 s, 120 000 evaluations
    const double u = normal_threshold(per_hour, step, window, true);
    std::mt19937_64 random(window);
    std::normal_distribution<double> normal;
    std::vector<double> ring(window, 0.0);
    double sum = 0.0;
    int clumps = 0;
    std::size_t last = 0;
    constexpr std::size_t kCount = 3'000'000;
    for (std::size_t n = 1; n <= kCount; ++n) {
      const double value = normal(random);
      sum += value - ring[n % window];
      ring[n % window] = value;
      if (n < window || std::abs(sum) < u * std::sqrt(static_cast<double>(window))) continue;
      if (last == 0 || n - last > window) ++clumps;
      last = n;
    }
    // 25 expected; Poisson's 0.1 % above, and no less than a quarter (the clump rate of an average is an upper one).
    EXPECT_LE(clumps, 25 + 3.1 * std::sqrt(25.0)) << window;
    EXPECT_GE(clumps, 6) << window;
  }
}

TEST(Defects, NoiseLevelsAreThoseSimulated) {
  const std::vector<double> sd{0.01, 0.02, 0.03, 0.015};
  const DefectReport report = find_defects(plain_array(sd, 30000, 1));
  ASSERT_EQ(report.noise.size(), 4U);
  // Medians over 3000 blocks of 9 degrees: 1 % of a residual's sd; solving for the quietest triples it; four sd of that. A
  // block's mean has a tenth of the variance. Its estimate is the larger of two, the worse of which is a median of 600
  // squares: 2.34/sqrt(600) of a residual's variance, which the K equations hand on to the sensor's own; four sd of that.
  double sum = 0.0;
  for (const double one : sd) sum += one * one;
  for (std::size_t k = 0; k < sd.size(); ++k) {
    const double own = sd[k] * sd[k] * 0.5;  // 1 - 2/K
    const double relative = 2.34 / std::sqrt(600.0) * (own + sum / 16.0) / own / 2.0;
    for (int c = 0; c < kChannels; ++c) {
      EXPECT_NEAR(report.noise[k].sample_sd(c) / sd[k], 1.0, 0.12) << k << c;
      EXPECT_NEAR(report.noise[k].block_sd(c) / (sd[k] / std::sqrt(10.0)), 1.0, 4.0 * relative) << k << c;
    }
  }
  EXPECT_TRUE(report.defects.empty());
}

TEST(Defects, BiasJumpIsSizedDatedAndTakenBackWithItsNewBias) {
  Signals signals = plain_array({0.01, 0.02, 0.03, 0.015}, 12000, 2);
  inject(signals, {DefectKind::kBiasJump, 1, 4, 4000, 12000, 0.1}, 2);
  const DefectReport report = find_defects(signals);
  ASSERT_EQ(report.defects.size(), 1U);
  const Defect& defect = report.defects.front();
  EXPECT_EQ(defect.sensor, 1U);
  EXPECT_EQ(defect.channels, 1U << 4);
  EXPECT_EQ(defect.kind, DefectKind::kBiasJump);
  EXPECT_NEAR(static_cast<double>(defect.from), 4000.0, 10.0);  // a block
  EXPECT_LE(defect.found, 4010U);  // 0.1 against 0.02/sqrt(10) and the others' noise: 13 sd of one block
  EXPECT_LE(defect.to, 4100U);     // in order, at its new level, from then on
  EXPECT_NEAR(defect.size.value(), 0.1, 5 * 0.02 / std::sqrt(500.0));  // five sd of a mean over 5 s
  std::vector<double> biases;
  for (const BiasRun& run : report.biases)
    if (run.sensor == 1 && (run.to <= defect.from || run.from >= defect.to)) biases.push_back(run.bias(4));
  ASSERT_EQ(biases.size(), 2U);
  EXPECT_NEAR(biases[1] - biases[0], 0.1, 6 * 0.02 / std::sqrt(4000.0));  // six sd of the shorter mean
  exclude(signals, report);
  EXPECT_FALSE(signals.sensors[1].may_use(4, 4005));
  EXPECT_TRUE(signals.sensors[1].may_use(3, 4005));
  EXPECT_TRUE(signals.sensors[1].may_use(4, 6000));
}

TEST(Defects, EachKindIsFoundAndNamed) {
  const std::vector<Injection> injections{
      {DefectKind::kBiasJump, 0, 1, 3000, 5000, 0.02},  {DefectKind::kScaleChange, 1, 5, 3000, 5000, 1.05},
      {DefectKind::kStuck, 2, 0, 3000, 5000, 0.0},      {DefectKind::kNoiseBurst, 3, 3, 3000, 5000, 0.2},
      {DefectKind::kDropout, 0, 2, 3000, 5000, 0.0},    {DefectKind::kDropout, 1, 2, 3000, 5000, 1.0},
      {DefectKind::kSwappedAxis, 2, 4, 3000, 5000, 0.0}};
  for (const Injection& injection : injections) {
    const DefectReport report = with_injection(injection, 7);
    const Defect* defect = defect_in(report, injection.sensor, injection.channel, 3000, 5000);
    ASSERT_NE(defect, nullptr) << name_of(injection.kind);
    // Gravity times a factor is a constant where the vertical force hardly varies.
    if (injection.kind != DefectKind::kScaleChange) {
      EXPECT_EQ(name_of(defect->kind), name_of(injection.kind));
    }
    for (const Defect& other : report.defects) EXPECT_EQ(other.sensor, injection.sensor) << name_of(injection.kind);
  }
}

TEST(Defects, StuckAndDropoutEndWhereTheyEnd) {
  for (const DefectKind kind : {DefectKind::kStuck, DefectKind::kDropout}) {
    const DefectReport report = with_injection({kind, 1, 2, 3000, 3500, 0.0}, 3);
    ASSERT_EQ(report.defects.size(), 1U);
    EXPECT_NEAR(static_cast<double>(report.defects[0].from), 3000.0, 1.0);
    EXPECT_EQ(report.defects[0].to, 3500U);
  }
}

TEST(Defects, CoarseSensorsAtRestMayRepeatAndAreStuckOnlyWhileOthersMove) {
  Signals signals = plain_array({0.01, 0.01, 0.01, 0.01}, 12000, 5);
  auto& values = signals.sensors[2].values;
  for (auto& s : signals.sensors)  // at rest for half of the time
    for (Eigen::Index n = 0; n < 6000; ++n)
      for (int c = 0; c < kChannels; ++c) s.values(c, n) -= std::sin(0.013 * static_cast<double>(n) + c);
  values = ((values.array() / 0.05).round() * 0.05).matrix();
  const DefectReport clean = find_defects(signals);
  for (const Defect& defect : clean.defects) EXPECT_NE(defect.kind, DefectKind::kStuck) << defect.from;
  inject(signals, {DefectKind::kStuck, 2, 1, 8000, 9000, 0.0}, 5);
  const Defect* stuck = defect_in(find_defects(signals), 2, 1, 8000, 9000);
  ASSERT_NE(stuck, nullptr);
}

TEST(Defects, DeadAbsentAndIdenticalSensorsDoNotSpoilTheRest) {
  Signals signals = plain_array({0.01, 0.01, 0.01, 0.01, 0.01}, 6000, 8);
  signals.sensors[0].values.row(2).setConstant(0.3);
  std::fill(signals.sensors[4].usable.begin(), signals.sensors[4].usable.end(), std::uint8_t{0});
  signals.sensors[4].values.setConstant(std::nan(""));
  inject(signals, {DefectKind::kBiasJump, 1, 2, 3000, 6000, 0.1}, 1);
  const DefectReport report = find_defects(signals);
  EXPECT_NE(defect_in(report, 0, 2, 0, 6000), nullptr);
  EXPECT_NE(defect_in(report, 1, 2, 3000, 3010), nullptr);
  EXPECT_NE(defect_in(report, 4, 0, 0, 1), nullptr);
  EXPECT_EQ(report.defects.size(), 3U);
  const Signals same{{}, 0.01, {signals.sensors[2], signals.sensors[2], signals.sensors[2]}};
  EXPECT_TRUE(find_defects(same).defects.empty());
}

TEST(Defects, TwoAtOnceAreFoundOneAfterTheOther) {
  Signals signals = plain_array({0.01, 0.01, 0.01, 0.01, 0.01}, 9000, 4);
  inject(signals, {DefectKind::kBiasJump, 1, 0, 4000, 9000, 0.1}, 1);
  inject(signals, {DefectKind::kBiasJump, 3, 0, 4000, 9000, -0.3}, 1);
  const DefectReport report = find_defects(signals);
  EXPECT_NE(defect_in(report, 1, 0, 4000, 4100), nullptr);
  EXPECT_NE(defect_in(report, 3, 0, 4000, 4100), nullptr);
  EXPECT_EQ(report.defects.size(), 2U);
}

TEST(Defects, ThreeSensorsNameTheOneAndTwoOnlyContradict) {
  const DefectReport three = with_injection({DefectKind::kBiasJump, 2, 1, 3000, 5000, 0.05}, 11, 3);
  EXPECT_NE(defect_in(three, 2, 1, 3000, 3100), nullptr);
  const DefectReport two = with_injection({DefectKind::kBiasJump, 1, 1, 3000, 9000, 0.05}, 11, 2);
  EXPECT_TRUE(two.defects.empty());
  ASSERT_EQ(two.disagreements.size(), 1U);
  EXPECT_EQ(two.disagreements[0].channel, 1);
  EXPECT_NEAR(static_cast<double>(two.disagreements[0].found), 3009.0, 20.0);
}

TEST(Defects, ImperfectLagsAndMountingAreNotDefects) {
  // Lags of up to 20 ms and 1 degree of misalignment, motion of 1 Hz: residuals of ten times the noise of a block.
  Signals signals = plain_array({0.005, 0.005, 0.005, 0.005, 0.005}, 12000, 6);
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    const double lag = 0.005 * static_cast<double>(k), angle = 0.017 * (static_cast<double>(k) - 2.0);
    for (Eigen::Index n = 0; n < 12000; ++n) {
      const double t = 0.01 * static_cast<double>(n) - lag;
      const double burst = std::max(0.0, std::sin(0.2 * t));
      const double x = burst * std::sin(2.0 * std::numbers::pi * t), y = burst * std::cos(4.4 * t);
      signals.sensors[k].values(0, n) += x + angle * y;
      signals.sensors[k].values(1, n) += y - angle * x;
    }
  }
  EXPECT_TRUE(find_defects(signals).defects.empty());
}

/// Every 7 s all sensors are knocked for 0.3 s, each in its own way: noise of some twenty times the usual, of a size that is
/// drawn, within a factor of two, for each sensor and axis.
TEST(Defects, KnocksThatEachSensorTakesInItsOwnWayAccuseNone) {
  const std::vector<double> sd{0.01, 0.01, 0.015, 0.01, 0.012};
  Signals signals = plain_array(sd, 30000, 11);
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> own(0.7, 1.4);
  for (Eigen::Index knock = 1000; knock + 30 < 30000; knock += 700)
    for (SensorSignals& sensor : signals.sensors)
      for (int c = 0; c < kChannels; ++c) {
        const double size = 0.2 * own(random);
        for (Eigen::Index n = knock; n < knock + 30; ++n) sensor.values(c, n) += size * normal(random);
      }
  EXPECT_TRUE(find_defects(signals).defects.empty());
  // .. and do not hide one that is: a constant of a third of a knock.
  inject(signals, {DefectKind::kBiasJump, 2, 1, 15200, 30000, 0.07}, 3);
  EXPECT_NE(defect_in(find_defects(signals), 2, 1, 15200, 15400), nullptr);
}

TEST(Defects, ValuesAtTheEndOfARangeAreNotCompared) {
  Signals signals = plain_array({0.01, 0.01, 0.01, 0.01}, 12000, 13);
  for (Eigen::Index n = 5000; n < 5200; ++n) signals.sensors[1].values(0, n) -= 1.0;
  const DefectReport told = find_defects(signals);
  EXPECT_NE(defect_in(told, 1, 0, 5000, 5200), nullptr);
  signals.sensors[1].limited.assign(12000, 0);
  for (std::size_t n = 5000; n < 5200; ++n) {
    signals.sensors[1].limited[n] = 0x07;
    signals.sensors[1].usable[n] = kAllUsable & ~0x07;
  }
  EXPECT_TRUE(find_defects(signals).defects.empty());  // nor are they a dropout
}

TEST(Defects, FalseAlarmsStayBelowTheStatedRate) {
  DefectStudyOptions options;
  options.detection.false_alarms_per_hour = 3.0;  // thirty times the default, to have something to count in 15 minutes
  options.clean_hours = 0.25;
  options.clean_piece_s = 300.0;
  const DefectStudyResult result = run_defect_study(options, 0, 1);
  // 0.75 expected: Poisson exceeds 4 in 0.1 % of cases.
  EXPECT_LE(result.false_alarms, 4U);
}

TEST(Defects, StudyIsTheSameTwiceAndFindsWhatIsLarge) {
  DefectStudyOptions options;
  options.clean_hours = 0.0;
  options.simulation.duration_s = 30.0;
  options.defect_s = 8.0;
  const DefectStudyResult one = run_defect_study(options, 2, 40), two = run_defect_study(options, 2, 40);
  ASSERT_EQ(one.rows.size(), two.rows.size());
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    EXPECT_EQ(one.rows[i].detected, two.rows[i].detected);
    EXPECT_EQ(one.rows[i].median_delay_s, two.rows[i].median_delay_s);
    if (one.rows[i].kind == DefectKind::kStuck || one.rows[i].kind == DefectKind::kDropout) {
      EXPECT_EQ(one.rows[i].detected, one.rows[i].injections);
    }
  }
}

TEST(Defects, WrongArgumentsAreRefused) {
  Signals signals = plain_array({0.01, 0.01, 0.01}, 3000, 1);
  const DefectReport report = find_defects(signals);
  EXPECT_THROW((void)find_defects(plain_array({0.01}, 3000, 1)), std::invalid_argument);
  EXPECT_THROW((void)find_defects(plain_array({0.01, 0.01}, 300, 1)), std::invalid_argument);
  EXPECT_THROW((void)find_defects(signals, {.false_alarms_per_hour = 0.0}), std::invalid_argument);
  DefectReport other = report;
  other.defects.emplace_back().sensor = 3;
  EXPECT_THROW(exclude(signals, other), std::invalid_argument);
  EXPECT_THROW(inject(signals, {DefectKind::kStuck, 5, 0, 0, 10, 0.0}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
