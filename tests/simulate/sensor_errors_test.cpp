#include "coast/simulate/sensor_errors.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "sensor.hpp"
#include "support/support.hpp"

namespace coast::simulate {
namespace {

using Eigen::Vector3d;

std::vector<double> gyro_x_errors(const noise::ImuErrorModel& m, std::size_t count, double dt, std::uint64_t seed) {
  const record::ImuRecording measured = with_errors(constant_truth(count, dt, Vector3d::Zero(), Vector3d::Zero()), m, seed);
  std::vector<double> errors;
  for (const record::ImuSample& sample : measured.samples) errors.push_back(sample.dtheta.x() / dt);
  return errors;
}

double autocovariance(const std::vector<double>& x, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t k = lag; k < x.size(); ++k) sum += x[k] * x[k - lag];
  return sum / static_cast<double>(x.size() - lag);
}

TEST(WithErrors, WhiteNoiseHasItsVarianceAtAnyRateAndNoMemory) {
  const noise::ImuErrorModel m = error_model("{process: white_noise, density: 0.01, unit: rad/s/sqrt(Hz)}");
  for (double dt : {0.005, 0.1}) {
    const std::vector<double> errors = gyro_x_errors(m, 40000, dt, 7);
    const double variance = 1e-4 / dt;
    const test::Chi2Bounds bounds = test::chi2_mean_bounds(1.0, 40000.0);
    EXPECT_GT(autocovariance(errors, 0), variance * bounds.lower);
    EXPECT_LT(autocovariance(errors, 0), variance * bounds.upper);
    EXPECT_LT(std::abs(autocovariance(errors, 1)), variance * 3.3 / std::sqrt(40000.0));  // 99.9 %
  }
}

// R(tau) = sigma^2 exp(-tau / T). The spread of the estimate over n samples, for a process of correlation time T:
// var <= 2 sigma^4 (2 T / (n dt)) (Bartlett); four of its standard deviations are allowed.
TEST(WithErrors, GaussMarkovHasItsAutocovariance) {
  const double sigma = 0.02;
  const double T = 5.0;
  const double dt = 0.05;
  const noise::ImuErrorModel m =
      error_model(fmt::format("{{process: gauss_markov, sigma: {}, unit: rad/s, correlation_time_s: {}}}", sigma, T));
  const std::vector<double> errors = gyro_x_errors(m, 2000000, dt, 3);
  const double tolerance = 4.0 * sigma * sigma * std::sqrt(4.0 * T / (2e6 * dt));
  ASSERT_LT(tolerance, 0.06 * sigma * sigma);
  for (std::size_t lag : {0u, 20u, 100u, 200u})
    EXPECT_NEAR(autocovariance(errors, lag), sigma * sigma * std::exp(-static_cast<double>(lag) * dt / T), tolerance) << lag;
}

// A walk's variance is q t; over many seeds, at one time.
TEST(WithErrors, RandomWalkGrowsWithTheRootOfTime) {
  const noise::ImuErrorModel m = error_model("{process: random_walk, density: 0.003, unit: rad/s/sqrt(s)}");
  double sum = 0.0;
  const int runs = 400;
  for (int seed = 0; seed < runs; ++seed) {
    const double last = gyro_x_errors(m, 200, 0.5, static_cast<std::uint64_t>(seed)).back();
    sum += last * last;
  }
  const double expected = 9e-6 * (99.5 + 0.5 * 0.25);  // x(99.5) + w/2, var w = q 0.5
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(1.0, runs);
  EXPECT_GT(sum / runs, expected * bounds.lower);
  EXPECT_LT(sum / runs, expected * bounds.upper);
}

TEST(WithErrors, RandomConstantIsDrawnOncePerRunAndAxis) {
  const noise::ImuErrorModel m = error_model("{process: random_constant, sigma: 0.5, unit: rad/s}");
  double sum = 0.0;
  const int runs = 2000;
  for (int seed = 0; seed < runs; ++seed) {
    const std::vector<double> errors = gyro_x_errors(m, 3, 0.01, static_cast<std::uint64_t>(seed));
    EXPECT_NEAR(errors[2], errors[0], 1e-14);
    sum += errors[0] * errors[0];
  }
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(1.0, runs);
  EXPECT_GT(sum / runs, 0.25 * bounds.lower);
  EXPECT_LT(sum / runs, 0.25 * bounds.upper);
}

TEST(WithErrors, ScaleFactorMultipliesItsOwnAxis) {
  const Vector3d force(3.0, 0.0, -9.8);
  const noise::ImuErrorModel m = error_model("", "{process: scale_factor, sigma: 1000, unit: ppm}");
  const record::ImuRecording measured = with_errors(constant_truth(5, 0.01, Vector3d::Zero(), force), m, 11);
  const Vector3d error = measured.samples[4].dv / 0.01 - force;
  EXPECT_EQ(error.y(), 0.0);
  EXPECT_GT(std::abs(error.x()), 0.0);
  EXPECT_LT(std::abs(error.x() / 3.0), 5e-3);
  EXPECT_GT(std::abs(error.z()), 0.0);
  EXPECT_EQ(measured.samples[4].dtheta, Vector3d::Zero());
}

// error_i = m_ij truth_j: a rate about x alone shows in y and z, never in x.
TEST(WithErrors, MisalignmentLeaksTheOtherAxes) {
  const Vector3d rate(0.5, 0.0, 0.0);
  const noise::ImuErrorModel m = error_model("{process: misalignment, sigma: 1, unit: mrad}");
  double sum = 0.0;
  const int runs = 500;
  for (int seed = 0; seed < runs; ++seed) {
    const record::ImuRecording measured =
        with_errors(constant_truth(1, 0.01, rate, Vector3d::Zero()), m, static_cast<std::uint64_t>(seed));
    const Vector3d error = measured.samples[0].dtheta / 0.01 - rate;
    EXPECT_NEAR(error.x(), 0.0, 1e-16);
    sum += error.y() * error.y() + error.z() * error.z();
  }
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(2.0, runs);
  EXPECT_GT(sum / runs, 0.25e-6 * bounds.lower);  // bounds are of the mean of chi2(2)
  EXPECT_LT(sum / runs, 0.25e-6 * bounds.upper);
}

TEST(WithErrors, StreamsAreRepeatableAndIndependent) {
  const std::string walk = "{process: random_walk, density: 0.003, unit: rad/s/sqrt(s)}";
  const std::string white = "{process: white_noise, density: 0.01, unit: rad/s/sqrt(Hz)}";
  const std::vector<double> alone = gyro_x_errors(error_model(walk), 50, 0.1, 5);
  EXPECT_EQ(alone, gyro_x_errors(error_model(walk), 50, 0.1, 5));
  EXPECT_NE(alone, gyro_x_errors(error_model(walk), 50, 0.1, 6));
  // A process added behind it, or to the other sensor, changes nothing of the first.
  const std::vector<double> both =
      gyro_x_errors(error_model(walk + ", " + white, "{process: white_noise, density: 1, unit: ug/sqrt(Hz)}"), 50, 0.1, 5);
  const std::vector<double> second =
      gyro_x_errors(error_model("{process: random_constant, sigma: 0, unit: rad/s}, " + white), 50, 0.1, 5);
  for (std::size_t k = 0; k < 50; ++k) EXPECT_NEAR(both[k], alone[k] + second[k], 1e-15);
  const record::ImuRecording measured =
      with_errors(constant_truth(20, 0.1, Vector3d::Zero(), Vector3d::Zero()), error_model(white), 5);
  EXPECT_NE(measured.samples[3].dtheta.x(), measured.samples[3].dtheta.y());
}

/// A walk's integral: two states with a singular initial covariance and correlated driving noise.
class IntegratedWalk final : public noise::Process {
 public:
  std::string_view name() const override { return "integrated_walk"; }
  int states() const override { return 2; }
  void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const override { Phi << 1.0, dt, 0.0, 1.0; }
  void driving_noise(double dt, Eigen::Ref<Eigen::MatrixXd> Q_d) const override {
    Q_d << dt * dt * dt / 3.0, dt * dt / 2.0, dt * dt / 2.0, dt;
  }
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const override { h << 1.0, 0.0; }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override { P.setZero(); }
  std::optional<double> allan_variance(double) const override { return {}; }     // grows with the length of the record
  std::optional<double> hadamard_variance(double) const override { return {}; }  // nobody asks for it here
  std::string yaml() const override { return ""; }
};

TEST(Realisation, StepsBlocksOfSeveralStates) {
  // var of the integrated walk at t: t^3 / 3; its mean over the last step, from the two ends, to first order in dt / t.
  const int runs = 1000;
  double sum = 0.0;
  for (int seed = 0; seed < runs; ++seed) {
    Realisation realisation(std::make_shared<IntegratedWalk>(), static_cast<std::uint64_t>(seed));
    double value = 0.0;
    for (int k = 0; k < 1000; ++k) value = realisation.next(0.01);
    sum += value * value;
  }
  const double t = 9.995;
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(1.0, runs);
  EXPECT_GT(sum / runs, t * t * t / 3.0 * bounds.lower);
  EXPECT_LT(sum / runs, t * t * t / 3.0 * bounds.upper);
}

}  // namespace
}  // namespace coast::simulate
