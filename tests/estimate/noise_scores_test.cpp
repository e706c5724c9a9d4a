// Scores of the noise against differences of the filter's own log-likelihood.

#include "noise_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coast/array/extended.hpp"
#include "estimate/mission.hpp"
#include "noise_objective.hpp"
#include "noise_search.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr NoiseFitChoice kAll{.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = true};

/// A mission with velocities, a correlated error, a lever arm and a time offset.
test::Recording wandering_recording(const noise::ImuErrorModel& model, double duration) {
  test::RecordingOptions options{.duration = duration, .imu_rate_hz = 50.0};
  options.gnss.rate_hz = 2.0;
  options.gnss.velocity_sd = Eigen::Vector3d(0.02, 0.02, 0.03);
  options.gnss.correlated = {Eigen::Vector3d(0.02, 0.02, 0.04), 5.0};
  options.gnss.lever_arm_b = {0.5, 0.2, -1.0};
  return test::make_recording(options, &model, 7);
}

/// Somewhere beside the truth, where no score is near zero.
Eigen::VectorXd beside_the_truth() {
  Eigen::VectorXd theta(12);
  theta << 0.1, -0.2, 0.1, std::log(0.02), std::log(0.03), std::log(5.0), 0.5, -0.4, 0.8, -0.5, 0.6, -0.7;
  return theta;
}

/// By four values, steps of 0.01 and 0.02 of a logarithm: what is left out is 1e-8 of a derivative.
double slope(NoiseObjective& objective, const Eigen::VectorXd& theta, Eigen::Index i) {
  const auto half_difference = [&](double step) {
    const Eigen::VectorXd d = step * Eigen::VectorXd::Unit(theta.size(), i);
    return (objective.value(theta + d) - objective.value(theta - d)) / (2.0 * step);
  };
  return (4.0 * half_difference(0.01) - half_difference(0.02)) / 3.0;
}

// In units of what a sigma of the parameter does to the log-likelihood. What differs is that the likelihood moves the nominal
// trajectory with the noise: the square of a tilt of 2 mrad and of scale factors of 5e-4 on a turning vehicle, 2e-3 as
// measured. A term that is missing in a score is of its own size.
void expect_scores_are_slopes(const Mission& mission, const noise::ImuErrorModel& model, const test::Recording& recording) {
  constexpr double kRelinearised = 5e-3;
  FilterOptions options;
  options.auxiliary.lever_arm_sd_m = 0.1;
  options.auxiliary.time_offset_sd_s = 0.01;
  const std::vector<NoiseParameter> parameters = free_parameters(kAll, true);
  const NoiseObjective::Start start = [&](const ForwardFilter& filter) {
    std::mt19937_64 random(3);
    return test::drawn_start(filter, recording.truth(test::mission_start()), {}, random);
  };
  NoiseObjective objective(mission, model, options, parameters, {}, start);
  const Eigen::VectorXd theta = beside_the_truth();
  ASSERT_TRUE(std::isfinite(objective.value(theta)));
  const NoiseScores scores = objective.scores();
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    const double sigma = 1.0 / std::sqrt(scores.information(i, i));
    const double expected = slope(objective, theta, i);
    const char* name = parameters[static_cast<std::size_t>(i)].name;
    EXPECT_NEAR(sigma * scores.gradient(i), sigma * expected, kRelinearised) << name;
    EXPECT_GT(std::abs(sigma * expected), 20.0 * kRelinearised) << name << ": nothing was compared";
  }
}

TEST(NoiseScores, AreTheSlopesOfTheLikelihood) {
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  const test::Recording recording = wandering_recording(model, 120.0);
  expect_scores_are_slopes(recording.mission(), model, recording);
}

// A lasting error ends where another set of ambiguities begins.
TEST(NoiseScores, HoldAcrossNewAmbiguities) {
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  test::Recording recording = wandering_recording(model, 120.0);
  test::float_between(recording.gnss, 81, 90);
  test::float_between(recording.gnss, 150, 151);
  expect_scores_are_slopes(recording.mission(), model, recording);
}

// Nothing of what the noise did before it reaches the attitude behind it.
TEST(NoiseScores, HoldAcrossARestart) {
  const noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  const test::Recording recording = wandering_recording(model, 120.0);
  Mission mission = recording.mission();
  const geo::GpsTime at = test::mission_start() + 60.03;
  mission.restarts = {
      {recording.truth(at), Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(0.1), Eigen::Vector3d(2e-3, 2e-3, 5e-3)}};
  expect_scores_are_slopes(mission, model, recording);
}

// The differences of merged IMUs have the white noise that the factors act on.
TEST(NoiseScores, CountTheDifferencesOfMembers) {
  const noise::ImuErrorModel own = test::error_model(test::kIndustrialModel);
  const std::vector<array::ModelledSensor> sensors{{"a", &own}, {"b", &own}};
  const noise::ImuErrorModel sum = array::extended_error_model("sum", 50.0, sensors);
  test::Recording recording = wandering_recording(sum, 60.0);
  recording.imu.members.names = {"a", "b"};
  std::mt19937_64 random(5);
  for (int second = 0; second < 59; ++second) {
    const geo::GpsTime from = test::mission_start() + second;
    record::MemberBlocks::Block block{from, from + 1.0, {}};
    for (int member = 0; member < 2; ++member)
      block.means.emplace_back(
          record::MemberBlocks::Means{1e-4 * test::normal_vector(3, random), 1e-3 * test::normal_vector(3, random)});
    recording.imu.members.blocks.push_back(std::move(block));
  }
  expect_scores_are_slopes(recording.mission(), sum, recording);
}

// Kuhn and Tucker: no coordinate that is free has a slope, none on a bound has one that leads inward.
TEST(BestStep, IsTheHighestPointOfTheBox) {
  std::mt19937_64 random(11);
  int on_bounds = 0;
  for (int k = 0; k < 20; ++k) {
    const Eigen::MatrixXd B = test::random_covariance(5, random);
    const Eigen::VectorXd g = 3.0 * test::normal_vector(5, random);
    const Eigen::VectorXd low = Eigen::VectorXd::Constant(5, -1.0), high = Eigen::VectorXd::Constant(5, 0.7);
    const Eigen::VectorXd step = best_step(g, B, low, high);
    const Eigen::VectorXd slope = g - B * step;
    for (Eigen::Index i = 0; i < 5; ++i) {
      ASSERT_GE(step(i), low(i));
      ASSERT_LE(step(i), high(i));
      if (step(i) == low(i)) {
        EXPECT_LT(slope(i), 0.0);
      } else if (step(i) == high(i)) {
        EXPECT_GT(slope(i), 0.0);
      } else {
        EXPECT_NEAR(slope(i), 0.0, 1e-7);
      }
      on_bounds += step(i) == low(i) || step(i) == high(i) ? 1 : 0;
    }
  }
  EXPECT_GT(on_bounds, 10);
  EXPECT_LT(on_bounds, 90);
}

// A parabola whose scores point beside its top, as those do that leave a share of the slope out: the search ends beside it, and
// goes there without ever going down.
TEST(Climb, EndsWhereScoresLeadNoHigher) {
  constexpr double kBeside = 0.3;  // sigmas
  int passes = 0;
  double last = 0.0;
  Eigen::VectorXd at;
  const Likelihood likelihood{
      .value =
          [&](const Eigen::VectorXd& theta) {
            ++passes;
            at = theta;
            return last = -0.5 * theta.squaredNorm();
          },
      .scores =
          [&] {
            return NoiseScores{-at + Eigen::VectorXd::Constant(2, kBeside), 0.2 * Eigen::MatrixXd::Identity(2, 2)};
          }};
  const Eigen::VectorXd far = Eigen::VectorXd::Constant(2, 40.0);
  SearchState state{point_at(likelihood, Eigen::Vector2d(3.0, -2.0)), {}};
  const double start = state.at.value;
  climb(likelihood, {-far, far}, 1e-3, state);
  EXPECT_GT(state.at.value, start);
  EXPECT_GT(state.at.value, -kBeside * kBeside);  // both coordinates beside the top by kBeside, or nearer
  EXPECT_LT(passes, 20);
}

}  // namespace
}  // namespace coast
