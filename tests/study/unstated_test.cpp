// What a run file leaves unstated is taken from the recording where the recording shows it, and left alone where it does not.

#include <gtest/gtest.h>

#include <algorithm>

#include "coast/geo/earth.hpp"
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

TEST(Unstated, NoiseThatInnovationsContradictIsFitted) {
  const simulate::Scenario scenario = test::drive(360.0, 33);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  study::Setup setup = nothing_stated(scenario);
  constexpr double kTooSmall = 20.0;
  setup.model = setup.model.with_white_noise_scaled(noise::Sensor::kGyro, 1.0 / kTooSmall)
                    .with_white_noise_scaled(noise::Sensor::kAccel, 1.0 / kTooSmall);
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  ASSERT_TRUE(adapted(mission, "noise_adapted"));
  ASSERT_TRUE(mission.noise_fit().has_value());
  // The accelerometer's white noise drives the velocity that 1600 fixes watch: known to some 10 %.
  EXPECT_NEAR(std::log(mission.noise_fit()->adjustment.accel_factor / kTooSmall), 0.0, 0.5);
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
