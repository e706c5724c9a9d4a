// Scores and information of effects that no state stands for, against the likelihood of filters that were told of them.

#include "coast/estimate/effect_pass.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>

#include "coast/geo/rotation.hpp"
#include "estimate/mission.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr int kLeverArm = 0;
constexpr int kTimeOffset = 1;
constexpr int kGyroScale = 2;
constexpr int kAccelBias = 3;
constexpr int kCoefficients = 4;

/// One of each way into the filter: position and velocity of the antenna, time, rate, specific force.
class FourEffects : public Effects {
 public:
  explicit FourEffects(const test::Recording& recording) : recording_(recording) {}
  [[nodiscard]] Eigen::Index size() const override { return kCoefficients; }
  void add_sensor_errors(const SampleView& sample, Eigen::Matrix3Xd& gyro_b, Eigen::Matrix3Xd& accel_b) const override {
    gyro_b(2, kGyroScale) = sample.omega_b.z();
    accel_b(0, kAccelBias) = 1.0;
  }
  void add_measurement_errors(const MeasurementView& m, Eigen::MatrixXd& D) const override {
    const Eigen::Matrix3d C = m.nav.q_b_e.toRotationMatrix();
    const Eigen::Vector3d l_rate = geo::skew(m.context.omega_eb_b) * m.context.lever_arm_b;
    if (m.kind == UpdateKind::kGnssPosition) {
      D.col(kLeverArm) = C.col(0);
      D.col(kTimeOffset) = -(m.nav.v_eb_e + C * l_rate);
    } else {
      D.col(kLeverArm) = (C * geo::skew(m.context.omega_eb_b)).col(0);
      constexpr double kHalf = 0.005;  // s
      const auto velocity = [&](double dt) -> Eigen::Vector3d { return recording_.truth(m.nav.t + dt).v_eb_e; };
      D.col(kTimeOffset) = (velocity(-kHalf) - velocity(kHalf)) / (2.0 * kHalf);
    }
  }

 private:
  const test::Recording& recording_;
};

class EffectPassTest : public testing::Test {
 protected:
  EffectPassTest() : model_(test::error_model(test::kIndustrialModel)) {
    simulate::GnssOptions gnss;
    gnss.phase = 0.0137;
    gnss.lever_arm_b = {0.5, 0.2, -1.0};
    gnss.velocity_sd = Eigen::Vector3d(0.05, 0.05, 0.08);
    recording_ = test::make_recording({.duration = 60.0, .gnss = gnss}, &model_, 11);
    options_.gate_probability = 0.0;
    options_.auxiliary.correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.03, .time_s = 20.0};
  }

  /// Filters with the coefficients given to the filter from `t0` on.
  double log_likelihood(const Eigen::Vector<double, kCoefficients>& told, geo::GpsTime t0, KnotStore* knots = nullptr,
                        const std::function<void(const ForwardFilter&, const Mission&)>& visit = {}) const {
    test::Recording recording = recording_;
    for (record::ImuSample& sample : recording.imu.samples) {
      if (sample.t - t0 < 1e-6) continue;
      sample.dtheta.z() *= 1.0 - told(kGyroScale);
      sample.dv.x() -= told(kAccelBias) * sample.dt;
    }
    Mission mission = recording.mission();
    if (told(kLeverArm) != 0.0 || told(kTimeOffset) != 0.0) {  // of the whole mission alone
      mission.lever_arm_b.x() += told(kLeverArm);
      mission.time_offset_s += told(kTimeOffset);
    }
    const ForwardFilter filter(mission, model_, options_);
    std::mt19937_64 random(3);
    FilterOutputs outputs;
    outputs.knots = knots;
    const FilterState start = test::drawn_start(filter, recording.truth(test::mission_start()), {}, random);
    const double value = filter.run(start, outputs).log_likelihood;
    if (visit) visit(filter, mission);
    return value;
  }

  /// r and N of the coefficients at the knot nearest `t0`, and the time of that knot.
  struct AtKnot {
    geo::GpsTime t;
    Eigen::VectorXd r;
    Eigen::MatrixXd N;
    Eigen::MatrixXd null;
  };
  AtKnot evidence(geo::GpsTime t0, Eigen::Index draws = 0, std::size_t memory_limit_bytes = std::size_t{64} << 20) const {
    AtKnot at;
    KnotStore knots(memory_limit_bytes);
    log_likelihood(Eigen::Vector<double, kCoefficients>::Zero(), t0, &knots,
                   [&](const ForwardFilter& filter, const Mission& mission) {
                     std::mt19937_64 random(5);
                     std::normal_distribution<double> normal;
                     EffectPassOptions options;
                     options.draws = draws;
                     options.draw = [&](geo::GpsTime, const Eigen::VectorXd&, Eigen::Ref<Eigen::MatrixXd> m) {
                       for (double& value : m.reshaped()) value = normal(random);
                     };
                     effect_pass(mission, filter.layout(), knots, FourEffects(recording_), options, [&](const Evidence& e) {
                       if (e.t >= t0) at = {e.t, e.r_effects, e.N_effects, e.null_r_effects};
                     });
                   });
    return at;
  }

  noise::ImuErrorModel model_;
  test::Recording recording_;
  FilterOptions options_;
};

// Central differences over a hundredth of a sigma. What is left is of the filter: the covariances of its innovations follow the
// nominal trajectory, and the increments of a sample that a knot splits are shared out by their slope: 1 % of a sigma.
TEST_F(EffectPassTest, ScoreAndInformationAreTheDerivativesOfTheLikelihood) {
  const geo::GpsTime start = test::mission_start();
  const AtKnot at = evidence(start);
  const double middle = log_likelihood(Eigen::Vector<double, kCoefficients>::Zero(), start);
  for (int i = 0; i < kCoefficients; ++i) {
    const double sigma = 1.0 / std::sqrt(at.N(i, i));
    const double h = 0.3 * sigma;
    Eigen::Vector<double, kCoefficients> told = Eigen::Vector<double, kCoefficients>::Zero();
    told(i) = h;
    const double above = log_likelihood(told, start);
    const double below = log_likelihood(-told, start);
    EXPECT_NEAR((above - below) / (2.0 * h) * sigma, -at.r(i) * sigma, 0.02) << i;
    EXPECT_NEAR((2.0 * middle - above - below) / (h * h) * sigma * sigma, 1.0, 0.02) << i;
  }
}

// Knots of long missions are in a file, from which all threads read.
TEST_F(EffectPassTest, ReadsSpilledKnotsAsThoseInMemory) {
  const geo::GpsTime start = test::mission_start();
  const AtKnot in_memory = evidence(start), spilled = evidence(start, 0, 10000);
  EXPECT_EQ(in_memory.r, spilled.r);
  EXPECT_EQ(in_memory.N, spilled.N);
}

TEST_F(EffectPassTest, CrossInformationIsTheMixedDerivative) {
  const geo::GpsTime start = test::mission_start();
  const AtKnot at = evidence(start);
  for (int i = 0; i < kCoefficients; ++i)
    for (int j = 0; j < i; ++j) {
      Eigen::Vector<double, kCoefficients> a = Eigen::Vector<double, kCoefficients>::Zero();
      a(i) = 0.3 / std::sqrt(at.N(i, i));
      Eigen::Vector<double, kCoefficients> b = Eigen::Vector<double, kCoefficients>::Zero();
      b(j) = 0.3 / std::sqrt(at.N(j, j));
      const double mixed = (log_likelihood(a + b, start) - log_likelihood(a - b, start) - log_likelihood(b - a, start) +
                            log_likelihood(-a - b, start)) /
                           (4.0 * 0.09);
      EXPECT_NEAR(-mixed, at.N(i, j) / std::sqrt(at.N(i, i) * at.N(j, j)), 0.02) << i << ' ' << j;
    }
}

TEST_F(EffectPassTest, AnEffectThatBeginsLaterIsJudgedFromThere) {
  const AtKnot at = evidence(test::mission_start() + 30.2);
  const double middle = log_likelihood(Eigen::Vector<double, kCoefficients>::Zero(), at.t);
  for (const int i : {kGyroScale, kAccelBias}) {
    const double sigma = 1.0 / std::sqrt(at.N(i, i));
    const double h = 0.3 * sigma;
    Eigen::Vector<double, kCoefficients> told = Eigen::Vector<double, kCoefficients>::Zero();
    told(i) = h;
    const double above = log_likelihood(told, at.t);
    const double below = log_likelihood(-told, at.t);
    EXPECT_NEAR((above - below) / (2.0 * h) * sigma, -at.r(i) * sigma, 0.02) << i;
    EXPECT_NEAR((2.0 * middle - above - below) / (h * h) * sigma * sigma, 1.0, 0.02) << i;
  }
}

// Scores of drawn innovations have the information as their covariance: that of M draws has M p^2 / 2 numbers of relative
// variance 1 / M; the trace of (N^-1 C - 1)^2 is p (p + 1) / M on average, and rarely three times that.
TEST_F(EffectPassTest, DrawnScoresHaveTheInformationAsCovariance) {
  constexpr Eigen::Index kDraws = 2000;
  const AtKnot at = evidence(test::mission_start(), kDraws);
  const Eigen::MatrixXd C = at.null * at.null.transpose() / static_cast<double>(kDraws);
  const Eigen::MatrixXd off = at.N.ldlt().solve(C) - Eigen::MatrixXd::Identity(kCoefficients, kCoefficients);
  EXPECT_LE((off * off).trace(), 3.0 * kCoefficients * (kCoefficients + 1.0) / static_cast<double>(kDraws));
  EXPECT_GT((off * off).trace(), 0.0);
}

// The recording errs by known amounts: the estimate of one effect alone is off by what its sigma says.
TEST_F(EffectPassTest, EstimateOfAnInjectedEffectIsWithinItsSigma) {
  const AtKnot clean = evidence(test::mission_start());
  const double bias = 30.0 / std::sqrt(clean.N(kAccelBias, kAccelBias));
  for (record::ImuSample& sample : recording_.imu.samples) sample.dv.x() += bias * sample.dt;
  const AtKnot at = evidence(test::mission_start());
  const double before = -clean.r(kAccelBias) / clean.N(kAccelBias, kAccelBias);
  const double after = -at.r(kAccelBias) / at.N(kAccelBias, kAccelBias);
  EXPECT_NEAR((after - before) / bias, 1.0, 0.01);  // thirty sigmas: the same noise, and what is not linear
}

/// A bias of a gyro in one sample.
class OneSample : public Effects {
 public:
  explicit OneSample(std::size_t index) : index_(index) {}
  [[nodiscard]] Eigen::Index size() const override { return 1; }
  void add_sensor_errors(const SampleView& sample, Eigen::Matrix3Xd& gyro_b, Eigen::Matrix3Xd& /*accel_b*/) const override {
    if (sample.index == index_) gyro_b(0, 0) = 1.0;
  }
  void add_measurement_errors(const MeasurementView& /*m*/, Eigen::MatrixXd& /*D*/) const override {}

 private:
  std::size_t index_;
};

// A motion is assumed in place of the sample that ends a gap, and no error of a sensor affects it.
TEST(EffectPass, WhatIsMissingCarriesNoErrors) {
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  test::Recording recording = test::make_recording({.duration = 60.0, .imu_rate_hz = 50.0}, &model, 11);
  constexpr std::size_t kFirstMissing = 1000, kMissing = 600;  // 12 s
  const auto first = recording.imu.samples.begin() + kFirstMissing;
  recording.imu.samples.erase(first, first + kMissing);
  const Mission mission = recording.mission();
  const ForwardFilter filter(mission, model, {});
  std::mt19937_64 random(3);
  KnotStore knots;
  FilterOutputs outputs;
  outputs.knots = &knots;
  static_cast<void>(filter.run(test::drawn_start(filter, recording.truth(test::mission_start()), {}, random), outputs));
  const auto information = [&](std::size_t index) {
    double N = 0.0;
    effect_pass(mission, filter.layout(), knots, OneSample(index), {}, [&](const Evidence& e) { N = e.N_effects(0, 0); });
    return N;
  };
  EXPECT_EQ(information(kFirstMissing), 0.0);
  EXPECT_GT(information(kFirstMissing - 1), 0.0);
  EXPECT_GT(information(kFirstMissing + 1), 0.0);
}

/// The scale factor of a gyro that turns little and is noisy.
class PitchScale : public Effects {
 public:
  explicit PitchScale(bool tells_slope) : tells_slope_(tells_slope) {}
  [[nodiscard]] Eigen::Index size() const override { return 1; }
  void add_sensor_errors(const SampleView& sample, Eigen::Matrix3Xd& gyro_b, Eigen::Matrix3Xd& /*accel_b*/) const override {
    gyro_b(1, 0) = sample.omega_b.y();
  }
  void add_own_slopes(const SampleView& /*sample*/, OwnSlopes& slopes) const override {
    slopes(1, 0) = tells_slope_ ? 1.0 : 0.0;
  }
  void add_measurement_errors(const MeasurementView& /*m*/, Eigen::MatrixXd& /*D*/) const override {}

 private:
  bool tells_slope_;
};

// Monte Carlo: what is measured of a rate is mostly noise, and noise is as large as itself. Without the correction each of
// these missions would seem to have a scale factor.
TEST(EffectPass, NoiseOfTheSensorIsNotItsScaleFactor) {
  constexpr int kMissions = 40;
  const noise::ImuErrorModel model = test::error_model(R"(schema: coast.imu_error_model/1
gyro: {all: [{process: white_noise, density: 0.3, unit: deg/s/sqrt(Hz)}, {process: random_constant, sigma: 0.1, unit: deg/s}]}
accel: {all: [{process: white_noise, density: 1000, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 5, unit: mg}]}
)");
  double corrected = 0.0, uncorrected = 0.0, squares = 0.0;
  for (int seed = 1; seed <= kMissions; ++seed) {
    const test::Recording recording =
        test::make_recording({.duration = 60.0, .imu_rate_hz = 50.0}, &model, static_cast<std::uint64_t>(seed));
    const Mission mission = recording.mission();
    const ForwardFilter filter(mission, model, {});
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    KnotStore knots;
    FilterOutputs outputs;
    outputs.knots = &knots;
    static_cast<void>(filter.run(test::drawn_start(filter, recording.truth(test::mission_start()), {}, random), outputs));
    const auto sigmas = [&](bool tells_slope) {
      double z = 0.0;
      effect_pass(mission, filter.layout(), knots, PitchScale(tells_slope), {},
                  [&](const Evidence& e) { z = -e.r_effects(0) / std::sqrt(e.N_effects(0, 0)); });
      return z;
    };
    corrected += sigmas(true) / kMissions;
    uncorrected += sigmas(false) / kMissions;
    squares += sigmas(true) * sigmas(true) / kMissions;
  }
  const double of_mean = std::sqrt(1.0 / kMissions);
  EXPECT_NEAR(corrected, 0.0, 3.3 * of_mean);  // one of a thousand
  EXPECT_GT(uncorrected, 10.0 * of_mean);
  EXPECT_LT(squares, 1.0 + 3.3 * std::sqrt(2.0 / kMissions));
}

}  // namespace
}  // namespace coast
