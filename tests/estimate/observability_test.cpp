// What the batch says of lever arm, time offset, base offset and constants: against the truth, and where it cannot know.

#include "coast/estimate/observability.hpp"

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"
#include "estimate/batch_mission.hpp"

namespace coast {
namespace {

using namespace estimate;

const MissionUnknown& unknown_called(const BatchSolution& solution, const std::string& name) {
  for (const MissionUnknown& unknown : solution.report.unknowns)
    if (unknown.name == name) return unknown;
  throw std::out_of_range(name);
}

TEST(Observability, VerdictFollowsItsLimits) {
  MissionUnknown unknown{"x", 0.0, 2.0, 0.9, "y", 0.5};
  EXPECT_EQ(unknown.observability(), Observability::kSeen);
  unknown.posterior_sd = 1.1;
  EXPECT_EQ(unknown.observability(), Observability::kWeaklySeen);
  unknown.correlation = -0.985;
  EXPECT_EQ(unknown.observability(), Observability::kTogether);
  unknown.posterior_sd = 1.81;
  EXPECT_EQ(unknown.observability(), Observability::kNotSeen);
  unknown.posterior_sd = 0.1;
  EXPECT_EQ(unknown.observability(), Observability::kTogether);
  EXPECT_EQ(name(Observability::kWeaklySeen), "weakly seen");
}

TEST(Observability, StatesHaveNamesOfTheirOwn) {
  const StateLayout layout(test::error_model(test::kFullModel), Eigen::Matrix3d::Identity(),
                           {.lever_arm_sd_m = 0.1,
                            .time_offset_sd_s = 0.1,
                            .mounting_sd = 0.1,
                            .base_offset_sd_m = 1.0,
                            .correlated_gnss = {.horizontal_m = 0.1, .vertical_m = 0.1, .time_s = 60.0}});
  const std::vector<std::string> names = state_names(layout);
  ASSERT_EQ(names.size(), static_cast<std::size_t>(layout.size()));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names[kPsi + 2], "attitude down");
  EXPECT_EQ(names[static_cast<std::size_t>(*layout.lever_arm())], "lever_arm forward");
  EXPECT_EQ(names[static_cast<std::size_t>(*layout.time_offset())], "gnss_time_offset");
  EXPECT_EQ(names[static_cast<std::size_t>(*layout.mounting() + 1)], "vehicle_mounting yaw");
  EXPECT_EQ(names[static_cast<std::size_t>(*layout.base_offset() + 1)], "base_offset east");
  EXPECT_NE(std::ranges::find(names, "gyro_y misalignment to x"), names.end());
}

// By hand: P and prior of two offsets in e, turned into N, E, D by the rotation of the place.
TEST(Observability, VectorsInEAreResolvedInNorthEastDown) {
  const StateLayout layout(test::error_model(test::kIndustrialModel), Eigen::Matrix3d::Identity(), {.base_offset_sd_m = 1.0});
  const int b = *layout.base_offset();
  FilterState state;
  const geo::Geodetic place{0.8, 0.3, 100.0};
  state.nav.r_eb_e = geo::ecef_from_geodetic(place);
  const Eigen::Matrix3d C_n_e = geo::C_n_e(place);
  state.x = Eigen::VectorXd::Zero(layout.size());
  state.x.segment<3>(b) = C_n_e * Eigen::Vector3d(1.0, -2.0, 3.0);
  state.P = Eigen::MatrixXd::Zero(layout.size(), layout.size());
  state.P.block<3, 3>(b, b) = C_n_e * Eigen::Vector3d(0.01, 0.04, 0.81).asDiagonal() * C_n_e.transpose();
  state.P.block<3, 3>(kPos, kPos) = C_n_e * Eigen::Vector3d(0.01, 0.16, 1.0).asDiagonal() * C_n_e.transpose();
  const Eigen::Matrix3d across = C_n_e * Eigen::Vector3d(-0.0099, 0.04, 0.0).asDiagonal() * C_n_e.transpose();
  state.P.block<3, 3>(b, kPos) = across;
  state.P.block<3, 3>(kPos, b) = across.transpose();
  const std::vector<MissionUnknown> unknowns = mission_unknowns(layout, {b, b + 1, b + 2}, layout.initial_covariance(), state);
  const std::array<double, 3> estimates{1.0, -2.0, 3.0}, deviations{0.1, 0.2, 0.9}, correlations{-0.99, 0.5, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(unknowns[i].estimate, estimates[i], 1e-12);
    EXPECT_NEAR(unknowns[i].prior_sd, 1.0, 1e-12);
    EXPECT_NEAR(unknowns[i].posterior_sd, deviations[i], 1e-12);
    EXPECT_NEAR(unknowns[i].correlation, correlations[i], 1e-9);
  }
  EXPECT_EQ(unknowns[0].with, "position north");
  EXPECT_EQ(unknowns[0].observability(), Observability::kTogether);
  EXPECT_EQ(unknowns[1].with, "position east");
  EXPECT_EQ(unknowns[1].observability(), Observability::kSeen);
}

test::RecordingOptions drive_with_antenna(double duration) {
  test::RecordingOptions options;
  options.duration = duration;
  options.gnss.rate_hz = 2.0;
  options.gnss.lever_arm_b = {0.5, 0.2, -1.0};
  return options;
}

// Wrong by what the prior allows; estimates are to lie within 4.5 of their sigmas: seven values, one in 20 000.
TEST(BatchObservability, LeverArmTimeOffsetAndScaleFactorsAreFound) {
  test::RecordingOptions recorded = drive_with_antenna(240.0);
  recorded.gnss.time_offset = 0.013;
  FilterOptions options;
  options.auxiliary.lever_arm_sd_m = 0.2;
  options.auxiliary.time_offset_sd_s = 0.02;
  test::Filtered mission(test::kIndustrialModel, recorded, options, 3, {});
  const Eigen::Vector3d wrong(0.15, -0.2, 0.1);
  mission.recording.lever_arm_b += wrong;
  mission.begin(3, {});
  mission.run();
  const BatchSolution solution = mission.batch();
  EXPECT_TRUE(solution.report.converged);
  const auto check = [&](const std::string& name, double truth) {
    const MissionUnknown& unknown = unknown_called(solution, name);
    EXPECT_LE(std::abs(unknown.estimate - truth), 4.5 * unknown.posterior_sd) << name;
    EXPECT_EQ(unknown.observability(), Observability::kSeen) << name << " " << unknown.ratio() << " " << unknown.correlation;
  };
  check("lever_arm forward", -wrong.x());
  check("lever_arm right", -wrong.y());
  check("lever_arm down", -wrong.z());
  check("gnss_time_offset", 0.013);
  EXPECT_EQ(unknown_called(solution, "gnss_time_offset").prior_sd, 0.02);
  EXPECT_EQ(solution.report.unknowns.size(), 3U + 1U + 12U);  // constants and scale factors of six axes
}

// Whatever all fixes are off by, the trajectory is off by; its sigmas say so. Only a start that is known from elsewhere can
// tell the two apart.
TEST(BatchObservability, BaseOffsetIsSeenFromAKnownStartAlone) {
  FilterOptions options;
  options.auxiliary.base_offset_sd_m = 1.0;
  const Eigen::Vector3d offset_n(0.8, -0.5, 0.6);
  for (const bool start_from_fixes : {true, false}) {
    test::Filtered mission(test::kIndustrialModel, drive_with_antenna(60.0), options, 4, {});
    const Eigen::Vector3d offset_e = geo::C_n_e(geo::geodetic_from_ecef(mission.recording.gnss.fixes[0].r_ea_e)) * offset_n;
    for (record::GnssFix& fix : mission.recording.gnss.fixes) fix.r_ea_e += offset_e;
    mission.begin(4, {});
    if (start_from_fixes) {
      mission.start.nav.r_eb_e += offset_e;
      tie_position_to_fixes(mission.filter->layout(), mission.start.P);
    }
    mission.run();
    const BatchSolution solution = mission.batch();
    const std::array<const char*, 3> components{"north", "east", "down"};
    for (std::size_t i = 0; i < 3; ++i) {
      const MissionUnknown& offset = unknown_called(solution, std::string("base_offset ") + components[i]);
      const double sd =
          std::sqrt(solution.smoothed.back().cov.position(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
      EXPECT_EQ(offset.with, std::string("position ") + components[i]);
      if (start_from_fixes) {
        EXPECT_EQ(offset.observability(), Observability::kNotSeen);
        EXPECT_GT(offset.ratio(), 0.999);
        EXPECT_NEAR(sd, 1.0, 1e-3);
      } else {
        EXPECT_LT(offset.ratio(), 0.11);  // the start's 0.1 m
        EXPECT_LE(std::abs(offset.estimate - offset_n(static_cast<Eigen::Index>(i))), 4.5 * offset.posterior_sd);
        EXPECT_LT(sd, 0.11);
      }
    }
  }
}

// What is not seen costs no digits either: the unknowns at knots are what fixes measure.
TEST(BatchObservability, BaseOffsetLeavesTheConditionAsItIs) {
  std::array<double, 2> condition{};
  for (const bool with_offset : {false, true}) {
    FilterOptions options;
    options.auxiliary.base_offset_sd_m = with_offset ? 1.0 : 0.0;
    test::Filtered mission(test::kIndustrialModel, drive_with_antenna(60.0), options, 4, {});
    tie_position_to_fixes(mission.filter->layout(), mission.start.P);
    mission.run();
    condition[with_offset ? 1 : 0] = mission.batch().report.condition;
  }
  EXPECT_LT(condition[1], 2.0 * condition[0]);
}

// Two constants of one axis are felt as their sum alone.
TEST(BatchObservability, WhatOnlyTheSumOfShowsIsSaidSo) {
  const std::string twice = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.2, unit: deg/sqrt(h)}, {process: random_constant, sigma: 30, unit: deg/h}]
accel:
  x: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg}]
  y: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg}]
  z: [{process: white_noise, density: 80, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 2, unit: mg},
      {process: rate_ramp, coefficient: 1e-6, unit: ug/h}, {process: random_constant, sigma: 2, unit: mg}]
)";
  test::Filtered mission(twice, drive_with_antenna(240.0), {}, 5, {});
  mission.run();
  const BatchSolution solution = mission.batch();
  int together = 0;
  for (const MissionUnknown& unknown : solution.report.unknowns) {
    if (unknown.name == "accel_z rate_ramp 2") {
      EXPECT_EQ(unknown.observability(), Observability::kNotSeen);  // far too small to be seen in four minutes
    } else if (unknown.name.starts_with("accel_z random_constant")) {
      ++together;
      EXPECT_EQ(unknown.observability(), Observability::kTogether);
      EXPECT_EQ(unknown.with, together == 1 ? "accel_z random_constant #2" : "accel_z random_constant");
      EXPECT_NEAR(unknown.ratio(), std::sqrt(0.5), 0.01);  // of two equal priors a perfectly known sum leaves half the variance
      EXPECT_LT(unknown.correlation, -0.98);
    } else {
      EXPECT_NE(unknown.observability(), Observability::kNotSeen) << unknown.name;
    }
  }
  EXPECT_EQ(together, 2);
}

}  // namespace
}  // namespace coast
