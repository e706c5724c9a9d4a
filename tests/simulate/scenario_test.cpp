#include "coast/simulate/scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"

namespace coast::simulate {
namespace {

namespace fs = std::filesystem;

Scenario parse(const std::string& text) {
  return Scenario::from(io::parse_yaml(text, "scenario.yaml"), [](const fs::path& file) { return io::load_yaml(file); });
}

const std::string kMinimal =
    "schema: coast.scenario/1\n"
    "trajectory: {kind: pedestrian, duration_s: 150, static_s: 40, course_deg: 20, origin_deg_m: [10, 179.9995, 30]}\n"
    "imu: {rate_hz: 50, axes: [y, x, -z], mounting_deg: [0, 5, -3], lever_arm_m: [0.1, 0.2, -0.3]}\n"
    "gnss: {rate_hz: 2, sd_m: [0, 0, 0], stated_sd_m: [0.01, 0.01, 0.02]}\n";

std::string message_of(const std::string& text) {
  try {
    (void)simulate(parse(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Scenario, GivesAMissionThatAgreesWithItself) {
  const Scenario scenario = parse(kMinimal + "outages: [{elapsed_s: 100, duration_s: 5}, {manoeuvre: walk}]\nseed: 3\n");
  const SimulatedMission mission = simulate(scenario, 2);
  ASSERT_EQ(mission.imu.samples.size(), 150u * 50u);
  ASSERT_EQ(mission.truth.states.size(), 150u * 50u + 1u);
  ASSERT_EQ(mission.gnss.fixes.size(), 301u);
  EXPECT_EQ(mission.imu.samples.back().t, scenario.start + 150.0);
  EXPECT_EQ(mission.outages[0].start, scenario.start + 100.0);
  EXPECT_EQ(mission.outages[1].duration, make_motion("pedestrian", scenario.motion).plan().manoeuvres[0].duration);

  // At rest the IMU, turned back by hand into the body, feels gravity downwards: axes, then the mounting's pitch and yaw.
  const Eigen::Vector3d f_s = mission.imu.samples[10].dv / 0.02;
  const Eigen::Vector3d f_turned(f_s.y(), f_s.x(), -f_s.z());
  const double c = std::cos(5 * geo::kDegree), s = std::sin(5 * geo::kDegree);
  const double cy = std::cos(3 * geo::kDegree), sy = std::sin(3 * geo::kDegree);
  // C_b_s = Rz(-3 deg) Ry(5 deg): gravity's reaction (0, 0, -g) goes to -g (s cy, -s sy, c).
  EXPECT_LT((f_turned - f_turned.norm() * Eigen::Vector3d(-s * cy, s * sy, -c)).norm(), 1e-5);

  // The error-free antenna is the lever arm away from the true IMU.
  for (std::size_t i = 0; i < mission.gnss.fixes.size(); i += 50) {
    const record::NavState& nav = mission.truth.states[25 * i];
    EXPECT_EQ(nav.t, mission.gnss.fixes[i].t);
    const Eigen::Vector3d l_ba_b = nav.q_b_e.conjugate() * (mission.gnss.fixes[i].r_ea_e - nav.r_eb_e);
    EXPECT_LT((l_ba_b - Eigen::Vector3d(0.1, 0.2, -0.3)).norm(), 1e-8);
  }
}

TEST(Scenario, SameSeedSameBytesOtherSeedOtherErrors) {
  const std::string noisy =
      "schema: coast.scenario/1\n"
      "trajectory: {kind: pedestrian, duration_s: 150, static_s: 40, origin_deg_m: [10, 20, 30]}\n"
      "imu: {rate_hz: 20}\ngnss: {sd_m: [0.1, 0.1, 0.1]}\n";
  const SimulatedMission one = simulate(parse(noisy + "seed: 4\n"), 1);
  const SimulatedMission again = simulate(parse(noisy + "seed: 4\n"), 3);
  const SimulatedMission other = simulate(parse(noisy + "seed: 5\n"), 1);
  for (std::size_t k = 0; k < one.imu.samples.size(); ++k) EXPECT_EQ(one.imu.samples[k].dv, again.imu.samples[k].dv);
  for (std::size_t k = 0; k < one.gnss.fixes.size(); ++k) {
    EXPECT_EQ(one.gnss.fixes[k].r_ea_e, again.gnss.fixes[k].r_ea_e);
    EXPECT_NE(one.gnss.fixes[k].r_ea_e, other.gnss.fixes[k].r_ea_e);
  }
}

// What an ensemble of seeds relies on: the error-free part is shared, and GNSS errors do not depend on the IMU's error model.
TEST(ErrorFreeMission, GivesTheRecordingsOfSimulateAndPairsThem) {
  const std::string base =
      "schema: coast.scenario/1\n"
      "trajectory: {kind: pedestrian, duration_s: 150, static_s: 40, origin_deg_m: [10, 20, 30]}\n"
      "imu: {rate_hz: 20}\ngnss: {sd_m: [0.1, 0.1, 0.1]}\nseed: 4\n";
  Scenario scenario = parse(base);
  const std::string white = "{process: white_noise, density: 0.1, unit: deg/sqrt(h)}";
  const auto model_with = [](const std::string& gyro) {
    return noise::ImuErrorModel::from(io::parse_yaml(
        "schema: coast.imu_error_model/1\nsensor: test\ngyro: {all: [" + gyro + "]}\naccel: {all: []}\n", "model.yaml"));
  };
  scenario.error_model = model_with(white + ", {process: random_constant, sigma: 5, unit: deg/h}");
  const SimulatedMission whole = simulate(scenario);
  const ErrorFreeMission error_free(scenario);
  const auto same = error_free.recorded(scenario.error_model, 4);
  const auto white_alone = error_free.recorded(model_with(white), 4);
  const auto no_errors = error_free.recorded(std::nullopt, 4);
  ASSERT_EQ(whole.imu.samples.size(), same.imu.samples.size());
  const Eigen::Vector3d bias =  // constant over the recording, so it is what tells the two models apart in every sample
      (whole.imu.samples[0].dtheta - white_alone.imu.samples[0].dtheta) / whole.imu.samples[0].dt;
  EXPECT_GT(bias.norm(), 0.0);
  for (std::size_t k = 0; k < whole.imu.samples.size(); ++k) {
    EXPECT_EQ(whole.imu.samples[k].dtheta, same.imu.samples[k].dtheta);
    EXPECT_NE(white_alone.imu.samples[k].dtheta, no_errors.imu.samples[k].dtheta);
    const Eigen::Vector3d difference = whole.imu.samples[k].dtheta - white_alone.imu.samples[k].dtheta;
    EXPECT_LT((difference - bias * whole.imu.samples[k].dt).norm(), 1e-15);  // rounding of increments below 1 rad
  }
  for (std::size_t k = 0; k < whole.gnss.fixes.size(); ++k) {
    EXPECT_EQ(whole.gnss.fixes[k].r_ea_e, same.gnss.fixes[k].r_ea_e);
    EXPECT_EQ(whole.gnss.fixes[k].r_ea_e, white_alone.gnss.fixes[k].r_ea_e);
  }
  EXPECT_EQ(whole.truth.states.back().r_eb_e, error_free.truth().states.back().r_eb_e);
}

TEST(Scenario, NamesWhatIsWrong) {
  EXPECT_EQ(message_of(kMinimal), "accepted");
  const auto replaced = [](const std::string& from, const std::string& to) {
    std::string text = kMinimal;
    return text.replace(text.find(from), from.size(), to);
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    const std::string message = message_of(text);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("scenario.yaml:"), std::string::npos) << message;
  };
  expect(replaced("pedestrian", "pedestrain"), "pedestrian");
  expect(replaced("duration_s: 150", "duration_s: 120"), "140");
  expect(replaced("course_deg", "course_degs"), "course_deg");
  expect(replaced("[10, 179.9995, 30]", "[91, 0, 30]"), "latitude");
  expect(replaced("rate_hz: 50", "rate_hz: 0"), "rate_hz");
  expect(replaced(", stated_sd_m: [0.01, 0.01, 0.02]", ""), "stated_sd_m");
  expect(replaced("sd_m: [0, 0, 0]", "sd_m: [0, -1, 0]"), "at least 0");
  expect(kMinimal + "outages: [{elapsed_s: 151, duration_s: 5}]\n", "within the mission");
  expect(kMinimal + "outages: [{elapsed_s: 100}]\n", "duration_s");
  expect(kMinimal + "seed: -1\n", "seed");
  EXPECT_NE(message_of(kMinimal + "outages: [{manoeuvre: run}]\n").find("walk"), std::string::npos);
}

// Every shipped scenario is valid, its outages lie well inside the mission, and every motion has one.
TEST(ShippedScenarios, AreValidAndCoverEveryMotion) {
  std::set<std::string> kinds;
  for (const auto& entry : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "scenarios")) {
    SCOPED_TRACE(entry.path().string());
    ASSERT_EQ(entry.path().extension(), ".yaml");
    const Scenario scenario =
        Scenario::from(io::load_yaml(entry.path()), [](const fs::path& file) { return io::load_yaml(file); });
    kinds.insert(scenario.kind);
    EXPECT_TRUE(scenario.error_model.has_value());
    EXPECT_GE(scenario.motion.duration, 600.0);
    const bool moves = scenario.kind != "at_rest";  // a static record has neither a start nor an outage
    EXPECT_GE(scenario.motion.static_start, moves ? 30.0 : 0.0);
    const AnalyticTrajectory motion = make_motion(scenario.kind, scenario.motion);
    EXPECT_GT(gnss_fixes(motion, scenario.start, scenario.gnss, scenario.seed).fixes.size(), 500u);
    const std::vector<StudiedOutage> outages = studied_outages(scenario, motion.plan());
    EXPECT_EQ(outages.empty(), !moves);
    for (const StudiedOutage& outage : outages) {
      EXPECT_GT(outage.start, scenario.start + scenario.motion.static_start + 60.0);
      EXPECT_LT(outage.start + outage.duration, scenario.start + scenario.motion.duration - 20.0);
    }
  }
  EXPECT_EQ(kinds.size(), motions().size());
}

}  // namespace
}  // namespace coast::simulate
