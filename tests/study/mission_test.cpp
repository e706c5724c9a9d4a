#include "coast/study/mission.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "coast/study/comparison.hpp"
#include "simulated.hpp"

namespace coast::study {
namespace {

double heading_error(const PreparedMission& mission, const record::Trajectory& truth) {
  return error_of({mission.start().nav, {}}, truth.states.front()).attitude.z();
}

TEST(PreparedMission, RefinesTheStartFromTheData) {
  const simulate::Scenario scenario = test::drive(360.0, 11);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const record::Trajectory truth = recording.truth;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  EXPECT_LE(mission.start().nav.t - truth.states.front().t, 0.5);
  // Smoothed heading after 170 s of driving with this IMU: sigma 0.02 deg, by the filter itself; five of them.
  EXPECT_LE(std::abs(heading_error(mission, truth)), 1.8e-3);
}

TEST(PreparedMission, RefusesRecordingsThatDoNotOverlap) {
  const simulate::Scenario scenario = test::drive(360.0, 1);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  for (record::GnssFix& fix : recording.gnss.fixes) fix.t = fix.t + 86400.0;
  EXPECT_THROW(PreparedMission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {}), InputError);
}

TEST(PreparedMission, FindsTheTimeOffset) {
  simulate::Scenario scenario = test::drive(360.0, 5);
  scenario.gnss.time_offset = 0.080;
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = test::setup_of(scenario);
  setup.filter.auxiliary.time_offset_sd_s = 0.1;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  // 1 cm of white noise per fix and a few m/s^2 of speed changes: below 1 ms (METHODS: 0.8 ms detectable in 30 min of driving).
  EXPECT_NEAR(mission.mission().time_offset_s, 0.080, 2e-3);
}

TEST(PreparedMission, LeverArmCheckFindsAMisclosure) {
  const simulate::Scenario scenario = test::drive(360.0, 7);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = test::setup_of(scenario);
  const Eigen::Vector3d wrong(0.15, -0.10, 0.0);
  setup.lever_arm_b += wrong;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  const LeverArmCheck check = check_lever_arm(mission, 0.5, {});
  for (int i = 0; i < 2; ++i) {
    EXPECT_LE(std::abs(check.difference_m(i) + wrong(i)), 4.0 * check.sd_m(i)) << i;  // 4 sigma: one in 16000
    EXPECT_LE(check.sd_m(i), 0.03) << i;                                              // else the sentence above says nothing
  }
}

TEST(PreparedMission, BackwardFilterAgreesWithTheTruthAndLeavesTheRecordingAsItWas) {
  const simulate::Scenario scenario = test::drive(360.0, 13);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const record::Trajectory truth = recording.truth;
  PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  const Solution solution = solve(mission, mission.options(), true, {}, {});
  const Eigen::Vector3d first = mission.mission().imu.samples.front().dtheta;
  const geo::GpsTime middle = mission.start().nav.t + 100.0;
  std::optional<estimate::FilterState> at_middle;
  mission.run_backward(mission.options(), mission.far_end(solution.forward.last),
                       [&](const estimate::FilterState& state) {
                         if (state.nav.t >= middle) at_middle = state;
                       },
                       {});
  EXPECT_EQ(mission.mission().imu.samples.front().dtheta, first);
  ASSERT_TRUE(at_middle.has_value());
  const auto& states = truth.states;
  const auto same =
      std::find_if(states.begin(), states.end(), [&](const auto& nav) { return std::abs(nav.t - at_middle->nav.t) < 1e-6; });
  ASSERT_NE(same, states.end());
  const auto d = estimate::error_between(at_middle->nav, *same);
  for (int i = 0; i < estimate::kNav; ++i)
    EXPECT_LE(std::abs(d(i)), 4.5 * std::sqrt(at_middle->P(i, i))) << i;  // nine values: 4.5 sigma is one in 16000
}

// A drift that is known counts from the first epoch on, wherever the alignment succeeds and in whichever direction the filter
// runs.
TEST(PreparedMission, KnownDriftsAreTheSameForwardAndBackward) {
  simulate::Scenario scenario = test::drive(360.0, 19);
  scenario.error_model = noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: random_constant, sigma: 5, unit: deg/h},
        {process: drift, slope: 1800, unit: deg/h/h}]
accel:
  all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 1, unit: mg},
        {process: drift, slope: -90000, unit: ug/h}, {process: rate_ramp, coefficient: 9000, unit: ug/h}]
)",
                                                                   "model.yaml"));
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const record::Trajectory truth = recording.truth;
  const geo::GpsTime first = recording.imu.samples.front().t - recording.imu.samples.front().dt;
  PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  const Solution solution = solve(mission, mission.options(), true, {}, {});
  int compared = 0;
  const auto check = [&](const estimate::FilterState& state) {
    for (const auto& block : solution.filter->layout().sensors()) {
      if (block.process->name() != "drift") continue;
      const double slope =
          block.sensor == noise::Sensor::kGyro ? geo::unit("deg/h/h").to_si * 1800.0 : geo::unit("ug/h").to_si * -90000.0;
      // Instants are rounded to a nanosecond, at every one of 2000 knots.
      EXPECT_NEAR(state.x(block.offset), slope * (state.nav.t - first), 4e-6 * std::abs(slope)) << block.name;
      EXPECT_EQ(state.x(block.offset + 1), slope) << block.name;
      ++compared;
    }
  };
  check(solution.forward.last);
  check(mission.start_state(*solution.filter));
  const geo::GpsTime middle = mission.start().nav.t + 100.0;
  std::optional<estimate::FilterState> at_middle;
  mission.run_backward(mission.options(), mission.far_end(solution.forward.last),
                       [&](const estimate::FilterState& state) {
                         if (state.nav.t >= middle) at_middle = state;
                       },
                       {});
  ASSERT_TRUE(at_middle.has_value());
  check(*at_middle);
  EXPECT_EQ(compared, 18);
  const auto same = std::find_if(truth.states.begin(), truth.states.end(),
                                 [&](const auto& nav) { return std::abs(nav.t - at_middle->nav.t) < 1e-6; });
  ASSERT_NE(same, truth.states.end());
  const auto d = estimate::error_between(at_middle->nav, *same);
  for (int i = 0; i < estimate::kNav; ++i)
    EXPECT_LE(std::abs(d(i)), 4.5 * std::sqrt(at_middle->P(i, i))) << i;  // nine values: 4.5 sigma is one in 16000
}

TEST(NoiseFit, RecoversTheScaleOfStatedSigmas) {
  simulate::Scenario scenario = test::drive(360.0, 17);
  scenario.gnss.stated_sd = Eigen::Vector3d(0.005, 0.005, 0.04);  // true: 0.010, 0.010, 0.020
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  const estimate::NoiseFit fit =
      mission.fit({.gnss_scale = true, .correlated_gnss = false, .imu_white_noise = false}, {}, 300.0, {});
  // 1500 fixes: the scale of 3000 horizontal innovations is known to 1/sqrt(2 * 3000) = 1.3 %, of 1500 vertical ones to 1.8 %.
  EXPECT_NEAR(fit.adjustment.gnss_scale.horizontal, 2.0, 4.0 * 0.013 * 2.0);
  EXPECT_NEAR(fit.adjustment.gnss_scale.vertical, 0.5, 4.0 * 0.018 * 0.5);
  EXPECT_GT(fit.log_likelihood_after, fit.log_likelihood_before);
}

// A receiver that smooths leaves no white noise beside the correlated error.
TEST(NoiseFit, AScaleOfWhichNothingIsLeftIsTold) {
  simulate::Scenario scenario = test::drive(360.0, 18);
  scenario.gnss.sd.setConstant(1e-5);
  scenario.gnss.stated_sd = Eigen::Vector3d::Constant(0.02);
  scenario.gnss.correlated = {Eigen::Vector3d::Constant(0.02), 4.0};
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  auto setup = test::setup_of(scenario);
  setup.noise_fit = estimate::NoiseFitChoice{.gnss_scale = true, .correlated_gnss = true};
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  const auto told = std::ranges::find(mission.adaptations(), "noise_on_bound", &record::Event::kind);
  ASSERT_NE(told, mission.adaptations().end());
  EXPECT_NE(told->text.find("gnss_scale_"), std::string::npos) << told->text;
  EXPECT_EQ(told->text.find("correlated"), std::string::npos) << told->text;
}

/// A drive whose start is given with a heading that is 6 deg off, and known to be: the filter needs the first minute to find
/// it.
class MultiPass : public testing::Test {
 protected:
  MultiPass() : scenario_(test::drive(360.0, 17)) {}
  [[nodiscard]] std::unique_ptr<PreparedMission> prepared(double wrong_fixes_m = 0.0) {
    simulate::SimulatedMission recording = simulate::simulate(scenario_);
    truth_ = recording.truth;
    study::Setup setup = test::setup_of(scenario_);
    ins::InitialState start;
    start.nav = truth_.states.front();
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(start.nav.r_eb_e));
    start.nav.q_b_e = geo::quaternion_from_rotation_vector(C_n_e.col(2) * (6.0 * geo::kDegree)) * start.nav.q_b_e;
    start.sd_position_n.setConstant(0.02);
    start.sd_velocity_n.setConstant(0.02);
    start.sd_attitude_n = geo::kDegree * Eigen::Vector3d(0.2, 0.2, 6.0);
    setup.start = start;
    gap_ = {start.nav.t + 150.0, start.nav.t + 180.0};
    setup.filter.gate_probability = 0.0;
    for (record::GnssFix& fix : recording.gnss.fixes)
      if (gap_.contains(fix.t)) fix.r_ea_e += Eigen::Vector3d::Constant(wrong_fixes_m);
    return std::make_unique<PreparedMission>(std::move(recording.imu), std::move(recording.gnss), setup, Progress{});
  }
  /// Root mean square of the heading error before `until_s` from the start, rad.
  [[nodiscard]] double heading_rms(const std::vector<record::TrajectoryEpoch>& epochs, double until_s) const {
    double sum = 0.0;
    double n = 0.0;
    for (const record::TrajectoryEpoch& epoch : epochs) {
      const auto at = std::ranges::lower_bound(truth_.states, epoch.nav.t + -1e-6, {}, &record::NavState::t);
      if (at == truth_.states.end() || std::abs(at->t - epoch.nav.t) > 1e-5 || at->t - truth_.states.front().t > until_s)
        continue;
      const double error = error_of(epoch, *at).attitude.z();
      sum += error * error;
      n += 1.0;
    }
    return std::sqrt(sum / n);
  }

  simulate::Scenario scenario_;
  record::Trajectory truth_;
  estimate::Withheld gap_{};
};

struct Delivered {
  std::vector<record::TrajectoryEpoch> forward;
  std::vector<record::TrajectoryEpoch> smoothed;
};

Delivered deliver(PreparedMission& mission, const estimate::FilterOptions& options, int passes) {
  Delivered delivered;
  SolutionOutputs outputs;
  outputs.forward = [&](const record::TrajectoryEpoch& epoch) { delivered.forward.push_back(epoch); };
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { delivered.smoothed.push_back(epoch); };
  std::optional<estimate::FilterState> carried;
  if (passes > 1) carried = carried_start(mission, options, passes, {});
  static_cast<void>(solve(mission, options, true, outputs, {}, carried));
  return delivered;
}

TEST_F(MultiPass, TheForwardFilterHasConvergedWhenTheMissionBegins) {
  const auto mission = prepared();
  const Delivered one = deliver(*mission, mission->options(), 1);
  const Delivered three = deliver(*mission, mission->options(), 3);
  ASSERT_EQ(three.forward.size(), one.forward.size());
  constexpr double kParked = 5.0;  // s, standing: nothing but the lever arm and the passes tell of the heading
  EXPECT_GT(heading_rms(one.forward, kParked), 0.5 * geo::kDegree);
  // Heading sigma of this IMU after a few minutes of driving: 0.02 deg by the filter; five of them.
  EXPECT_LT(heading_rms(three.forward, kParked), 0.1 * geo::kDegree);
  EXPECT_LT(heading_rms(three.smoothed, kParked), 0.1 * geo::kDegree);
}

TEST_F(MultiPass, TheSmoothedSigmasCountAFixOnce) {
  const auto mission = prepared();
  const Delivered one = deliver(*mission, mission->options(), 1);
  const Delivered three = deliver(*mission, mission->options(), 3);
  // Sigmas depend on the data through the linearisation alone: 6 deg of heading against none, 1 - cos 6 deg.
  for (const std::size_t i : {std::size_t{100}, one.smoothed.size() / 2, one.smoothed.size() - 100})
    EXPECT_NEAR(three.smoothed[i].cov.position.trace() / one.smoothed[i].cov.position.trace(), 1.0, 0.01) << i;
  // And the forward filter's do count it again: at the start three passes know what the smoother knows, not what alignment
  // knew.
  EXPECT_LT(three.forward[100].cov.attitude(2, 2), 1e-3 * one.forward[100].cov.attitude(2, 2));
}

TEST_F(MultiPass, WithheldFixesAreSeenByNoPass) {
  const auto good = prepared();
  const auto spoiled = prepared(50.0);
  estimate::FilterOptions options = good->options();
  options.withheld.push_back(gap_);
  const Delivered a = deliver(*good, options, 3);
  const Delivered b = deliver(*spoiled, options, 3);
  ASSERT_EQ(a.smoothed.size(), b.smoothed.size());
  for (std::size_t i = 0; i < a.smoothed.size(); i += 50) {
    ASSERT_EQ(a.smoothed[i].nav.r_eb_e, b.smoothed[i].nav.r_eb_e) << i;
    ASSERT_EQ(a.forward[i].nav.r_eb_e, b.forward[i].nav.r_eb_e) << i;
  }
}

}  // namespace
}  // namespace coast::study
