// What a run file leaves unstated is taken from the recording where the recording shows it, and left alone where it does not.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"
#include "coast/study/mission.hpp"
#include "coast/study/plausibility.hpp"
#include "simulated.hpp"

namespace coast::study {
namespace {

bool adapted(const PreparedMission& mission, std::string_view kind) {
  return std::ranges::find(mission.adaptations(), kind, &record::Event::kind) != mission.adaptations().end();
}

study::Setup nothing_stated(const simulate::Scenario& scenario) {
  study::Setup setup = test::setup_of(scenario);
  setup.unstated = {.noise = {.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = true}, .time_offset = true};
  return setup;
}

struct Shift {
  double truth;
  double seen;  ///< by turns, right or not
};
class TimeOffset : public testing::TestWithParam<Shift> {};

// 2 ms: five times what 5 Hz fixes of a centimetre leave of it on this drive (as in FindsTheTimeOffset).
TEST_P(TimeOffset, IsFoundAndAFalseOneRejected) {
  simulate::Scenario scenario = test::drive(360.0, 31);
  scenario.gnss.time_offset = GetParam().truth;
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = nothing_stated(scenario);
  setup.unstated.time_offset_seen_s = GetParam().seen;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  EXPECT_NEAR(mission.mission().time_offset_s, GetParam().truth, 2e-3);
  EXPECT_EQ(adapted(mission, "time_offset_found"), GetParam().truth != 0.0);
  EXPECT_FALSE(adapted(mission, "noise_adapted"));
}
INSTANTIATE_TEST_SUITE_P(Shifts, TimeOffset,
                         testing::Values(Shift{0.0, 0.0}, Shift{0.0, 1.05}, Shift{0.08, 0.0}, Shift{-0.7, -0.66},
                                         Shift{1.5, 1.46}));

struct WrongArm {
  Eigen::Vector3d error;
  double offset_s;
};
class LeverArm : public testing::TestWithParam<WrongArm> {};

// Beside a time offset too. 4 sigma: one in 16000 for each component; a centimetre is what 5 Hz fixes of a centimetre leave.
TEST_P(LeverArm, IsFoundWhereItIsWrongAndLeftWhereItIsRight) {
  simulate::Scenario scenario = test::drive(360.0, 43);
  scenario.gnss.time_offset = GetParam().offset_s;
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = nothing_stated(scenario);
  setup.unstated.lever_arm = true;
  setup.lever_arm_b += GetParam().error;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  const bool wrong = !GetParam().error.isZero();
  const bool large = GetParam().error.norm() > 0.15;  // more than a tape measure misses: a warning
  EXPECT_EQ(adapted(mission, "lever_arm_contradicted"), large);
  EXPECT_EQ(adapted(mission, "lever_arm_found"), wrong && !large);
  EXPECT_EQ(adapted(mission, "time_offset_found"), GetParam().offset_s != 0.0);
  EXPECT_FALSE(adapted(mission, "noise_adapted"));
  EXPECT_NEAR(mission.mission().time_offset_s, GetParam().offset_s, 2e-3);
  const Eigen::Vector3d left = mission.mission().lever_arm_b - scenario.gnss.lever_arm_b;
  EXPECT_LT(left.head<2>().norm(), wrong ? 0.03 : 1e-9);
  EXPECT_LT(std::abs(left.z()), wrong ? 0.1 : 1e-9);  // a car tilts by a degree or two
}
INSTANTIATE_TEST_SUITE_P(Arms, LeverArm,
                         testing::Values(WrongArm{{0.0, 0.0, 0.0}, 0.0}, WrongArm{{-0.6, 0.4, 2.2}, 0.0},
                                         WrongArm{{-0.3, 0.2, 0.0}, 0.0}, WrongArm{{-0.3, 0.2, 0.0}, 0.08},
                                         WrongArm{{0.0, 0.0, 0.0}, 0.08}, WrongArm{{0.0, 0.12, 0.0}, 0.0}));

TEST(Unstated, LeverArmThatIsStatedWithItsSigmaIsKept) {
  const simulate::Scenario scenario = test::drive(360.0, 43);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = test::setup_of(scenario);
  setup.unstated.time_offset = true;
  setup.lever_arm_b.y() += 0.12;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  EXPECT_EQ(mission.mission().lever_arm_b, setup.lever_arm_b);
}

TEST(Unstated, NoiseThatInnovationsContradictIsFitted) {
  const simulate::Scenario scenario = test::drive(360.0, 33);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = nothing_stated(scenario);
  constexpr double kTooSmall = 20.0;
  setup.model = setup.model.with_white_noise_scaled(noise::Sensor::kGyro, Eigen::Vector3d::Constant(1.0 / kTooSmall))
                    .with_white_noise_scaled(noise::Sensor::kAccel, Eigen::Vector3d::Constant(1.0 / kTooSmall));
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  ASSERT_TRUE(adapted(mission, "noise_adapted"));
  ASSERT_TRUE(mission.noise_fit().has_value());
  // The accelerometer's white noise drives the velocity that 1600 fixes watch: known to some 10 %.
  for (const double factor : mission.noise_fit()->adjustment.accel_factors) EXPECT_NEAR(std::log(factor / kTooSmall), 0.0, 0.5);
}

// 360 s of a correlation time of 100 s are about two independent values an axis: the largest of six sample variances,
// chi-square of two degrees of freedom over two each, is within a factor of 2.5^2 in 99 %.
TEST(Unstated, DriftOfBiasesThatTheModelForbidsIsAdapted) {
  simulate::Scenario scenario = test::drive(360.0, 39);
  const auto model_of = [](double gyro_deg_h, double accel_mg) {
    return noise::ImuErrorModel::from(io::parse_yaml(fmt::format(R"(
schema: coast.imu_error_model/1
gyro:
  all: [{{process: white_noise, density: 0.1, unit: deg/sqrt(h)}}, {{process: random_constant, sigma: 5, unit: deg/h}},
        {{process: gauss_markov, sigma: {}, unit: deg/h, correlation_time_s: 100}}]
accel:
  all: [{{process: white_noise, density: 60, unit: ug/sqrt(Hz)}}, {{process: random_constant, sigma: 1, unit: mg}},
        {{process: gauss_markov, sigma: {}, unit: mg, correlation_time_s: 100}}]
)",
                                                                 gyro_deg_h, accel_mg),
                                                     "model.yaml"));
  };
  constexpr double kTooSmall = 40.0;
  scenario.error_model = model_of(400.0, 4.0);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = nothing_stated(scenario);
  setup.model = model_of(400.0 / kTooSmall, 4.0 / kTooSmall);
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  EXPECT_TRUE(adapted(mission, "bias_drift_adapted"));
  EXPECT_NEAR(std::log(mission.drift().largest() / kTooSmall), 0.0, std::log(2.5));
}

TEST(Unstated, HeadingThatMotionDoesNotShowIsAssumedAndTold) {
  simulate::Scenario scenario = simulate::Scenario::from(io::parse_yaml(R"(
schema: coast.scenario/1
trajectory: {kind: car_straight, duration_s: 300, static_s: 0, origin_deg_m: [46.52, 6.57, 400], course_deg: 65}
imu: {rate_hz: 100, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 1, sd_m: [20, 20, 30]}
start_gps: {week: 2374, sow: 208800}
seed: 41
)",
                                                                        "scenario.yaml"),
                                                         [](const std::filesystem::path& file) { return io::load_yaml(file); });
  scenario.error_model = test::tactical_model();
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const record::NavState truth = recording.truth.states.back();
  simulate::SimulatedMission same = recording;
  EXPECT_THROW(PreparedMission(std::move(same.imu), std::move(same.gnss), test::setup_of(scenario), {}), NumericalError);
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), nothing_stated(scenario), {});
  EXPECT_TRUE(mission.heading_assumed());
  EXPECT_TRUE(adapted(mission, "heading_assumed"));
  const estimate::FilterState last = solve(mission, mission.options(), false, {}, {}).forward.last;
  const Eigen::Vector3d psi = estimate::error_between(last.nav, truth).segment<3>(estimate::kPsi);
  EXPECT_LT(psi.norm(), 5.0 * geo::kDegree);  // the mounting is assumed to 4 deg
}

TEST(BiasDrift, IsTheRootOfTheMeanSquareOverTheModels) {
  const noise::ImuErrorModel model = noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
gyro: {all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: gauss_markov, sigma: 5, unit: deg/h, correlation_time_s: 80}]}
accel: {all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 1, unit: mg}]}
)",
                                                                               "model.yaml"));
  const estimate::StateLayout layout(model, Eigen::Matrix3d::Identity(), {});
  const double sigma = 5.0 * geo::kDegree / 3600.0;
  std::vector<estimate::SmoothedKnot> knots(2);
  for (estimate::SmoothedKnot& knot : knots) knot.x = knot.sd = Eigen::VectorXd::Zero(layout.size());
  const auto y = std::ranges::find_if(layout.sensors(), [](const auto& block) { return block.axis == 1; });
  knots[0].x(y->offset) = 4.0 * sigma;
  knots[1].sd(y->offset) = 2.0 * sigma;
  const DriftFactors seen = drift_seen(layout, knots, 2.0);
  EXPECT_NEAR(seen.gyro.y(), std::sqrt(10.0), 1e-12);  // (16 + 4) / 2
  EXPECT_EQ(seen.gyro.x(), 1.0);
  EXPECT_EQ(seen.accel.maxCoeff(), 1.0);
  const noise::ImuErrorModel scaled = with_drift_scaled(model, 100.0, seen);
  const auto allan = [](const noise::ImuErrorModel& m, std::size_t axis) {
    return *m.axes(noise::Sensor::kGyro)[axis][1]->allan_variance(30.0);
  };
  EXPECT_NEAR(allan(scaled, 1) / allan(model, 1), 10.0, 1e-9);
  EXPECT_EQ(allan(scaled, 0), allan(model, 0));
}

TEST(Unstated, VelocitiesThatLagThePositionsAreMovedToThem) {
  const simulate::Scenario scenario = test::drive(360.0, 35);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  constexpr double kLag = 0.12;
  const auto& states = recording.truth.states;
  for (record::GnssFix& fix : recording.gnss.fixes) {
    const auto at = std::ranges::lower_bound(states, fix.t - kLag, {}, &record::NavState::t);
    const record::NavState& nav = at == states.end() ? states.back() : *at;
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e)).transpose();
    fix.velocity = {C_e_n * nav.v_eb_e, 0.05 * 0.05 * Eigen::Matrix3d::Identity()};
  }
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), nothing_stated(scenario), {});
  EXPECT_TRUE(adapted(mission, "velocity_lag_removed"));
  EXPECT_NEAR(mission.mission().time_offset_s, 0.0, 5e-3);
}

TEST(Plausibility, VibrationIsOneForWhiteNoiseAlone) {
  simulate::Scenario scenario = test::drive(360.0, 37);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  auto& samples = recording.imu.samples;
  samples.resize(2500);  // at rest
  // Differences of neighbours of 25 seconds of white noise: a median within 5 %.
  EXPECT_NEAR(vibration_over_white_noise(recording.imu, *scenario.error_model), 1.0, 0.1);
  EXPECT_FALSE(has_gain_errors(*scenario.error_model));
}

}  // namespace
}  // namespace coast::study
