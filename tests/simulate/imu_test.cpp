#include "coast/simulate/imu.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/simulate/motions.hpp"

namespace coast::simulate {
namespace {

using Eigen::Vector3d;
using geo::kDegree;

AnalyticTrajectory motion(std::string_view kind, double duration = 310.0) {
  MotionParameters parameters;
  parameters.origin = {46.52 * kDegree, 6.57 * kDegree, 400.0};
  parameters.duration = duration;
  parameters.static_start = 10.0;
  return make_motion(kind, parameters);
}

struct Difference {
  double dtheta = 0.0;
  double dv = 0.0;
};

// `fine` has `ratio` samples in every one of `coarse`: increments in fixed sensor axes add up.
Difference largest_difference(const record::ImuRecording& coarse, const record::ImuRecording& fine, std::size_t ratio) {
  EXPECT_EQ(fine.samples.size(), ratio * coarse.samples.size());
  Difference largest;
  for (std::size_t k = 0; k < coarse.samples.size(); ++k) {
    Vector3d dtheta = -coarse.samples[k].dtheta;
    Vector3d dv = -coarse.samples[k].dv;
    for (std::size_t i = 0; i < ratio; ++i) {
      dtheta += fine.samples[ratio * k + i].dtheta;
      dv += fine.samples[ratio * k + i].dv;
    }
    largest.dtheta = std::max(largest.dtheta, dtheta.norm());
    largest.dv = std::max(largest.dv, dv.norm());
  }
  return largest;
}

class EveryMotionsIncrements : public ::testing::TestWithParam<MotionKind> {};

// The documented bounds; eight nodes gain six orders in the interval.
TEST_P(EveryMotionsIncrements, AreConvergedInNodes) {
  const AnalyticTrajectory truth = motion(GetParam().name, GetParam().shortest + 10.0);
  const record::ImuRecording recording = true_increments(truth, {{}, 100.0, {}});
  const Difference nodes = largest_difference(recording, true_increments(truth, {{}, 100.0, 8}), 1);
  EXPECT_LT(nodes.dtheta, 1e-13);
  EXPECT_LT(nodes.dv, 5e-13);
}

INSTANTIATE_TEST_SUITE_P(Simulate, EveryMotionsIncrements, ::testing::ValuesIn(motions()),
                         [](const auto& test) { return std::string(test.param.name); });

// The same over halved panels, where the motion is fastest.
TEST(TrueIncrements, AreConvergedInPanels) {
  const AnalyticTrajectory truth = motion("pedestrian", 110.0);
  const Difference panels =
      largest_difference(true_increments(truth, {{}, 100.0, {}}), true_increments(truth, {{}, 200.0, {}}), 2);
  EXPECT_LT(panels.dtheta, 1e-13);
  EXPECT_LT(panels.dv, 5e-13);
}

// Two nodes integrate cubics: halving the panel must gain 2^4 per unit of time on a smooth motion.
TEST(TrueIncrements, ConvergeWithTheOrderOfTheRule) {
  const AnalyticTrajectory truth = motion("pedestrian", 110.0);
  const record::ImuRecording exact = true_increments(truth, {{}, 100.0, 10});
  const double coarse = largest_difference(exact, true_increments(truth, {{}, 100.0, 2}), 1).dtheta;
  const double fine = largest_difference(exact, true_increments(truth, {{}, 200.0, 2}), 2).dtheta;
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.3);
}

// At rest: the Earth's rate and the reaction to gravity, in closed form.
TEST(TrueIncrements, AtRestAreEarthRateAndMinusGravity) {
  MotionPlan plan;
  plan.origin = {-33.9 * kDegree, -70.6 * kDegree, 520.0};
  plan.duration = 2.0;
  plan.course = Steps(30.0 * kDegree);
  const record::ImuRecording recording = true_increments(AnalyticTrajectory(plan), {{}, 50.0, 5});
  ASSERT_EQ(recording.samples.size(), 100u);
  const double latitude = plan.origin.latitude;
  const Eigen::Matrix3d C_n_b = geo::dcm_from_euler({0.0, 0.0, 30.0 * kDegree}).transpose();
  const Vector3d omega_n(geo::kEarthRate * std::cos(latitude), 0.0, -geo::kEarthRate * std::sin(latitude));
  const double g = geo::gravity_e(geo::ecef_from_geodetic(plan.origin)).norm();
  for (const record::ImuSample& sample : recording.samples) {
    EXPECT_DOUBLE_EQ(sample.dt, 0.02);
    EXPECT_LT((sample.dtheta - 0.02 * C_n_b * omega_n).norm(), 1e-17);
    // The plumb line at 520 m leaves the ellipsoid's normal by 1e-7 rad, g in the norm not at all.
    EXPECT_LT((sample.dv - Vector3d(0.0, 0.0, -0.02 * g)).norm(), 0.02 * g * 1e-6);
    EXPECT_NEAR(sample.dv.norm(), 0.02 * g, 0.02 * 3e-13);  // normal gravity is good to 1e-13 m/s^2, its terms cancel
  }
}

// On a circle at constant speed a lever arm to the outside sees the centripetal acceleration omega^2 (r + l).
TEST(TrueIncrements, LeverArmAddsCentripetalAcceleration) {
  MotionPlan plan;
  plan.origin = {0.0, 0.0, 0.0};
  plan.duration = 30.0;
  plan.speed = Steps(10.0);
  std::vector<Step> circle;
  for (int i = -60; i < 120; ++i) circle.push_back({0.5 * i, 3.0, 0.2 * 0.5});
  plan.course = Steps(0.0, circle);  // 0.2 rad/s to the right
  const AnalyticTrajectory truth(plan);
  const ImuSampling sampling{{}, 100.0, 5};
  const record::ImuRecording at_body = true_increments(truth, sampling);
  const record::ImuRecording outside =
      true_increments(truth, sampling, {Vector3d(0.0, -2.0, 0.0), Eigen::Matrix3d::Identity()});
  for (std::size_t k = 500; k < 2500; ++k) {
    const Vector3d difference = (outside.samples[k].dv - at_body.samples[k].dv) / 0.01;
    // The Earth's rotation adds 2 omega omega_ie l = 6e-5; the place differs by 2 m of gravity, 6e-6.
    EXPECT_LT((difference - Vector3d(0.0, 0.2 * 0.2 * 2.0, 0.0)).norm(), 1e-4);
    EXPECT_LT((outside.samples[k].dtheta - at_body.samples[k].dtheta).norm(), 1e-18);
  }
}

TEST(TrueIncrements, MountingRotatesBothIncrements) {
  const AnalyticTrajectory truth = motion("boat");
  const Eigen::Matrix3d C_b_s = geo::dcm_from_euler({0.1, -0.2, 2.0});
  const record::ImuRecording body = true_increments(truth, {{}, 10.0, 5});
  const record::ImuRecording sensor = true_increments(truth, {{}, 10.0, 5}, {Vector3d::Zero(), C_b_s});
  for (std::size_t k = 0; k < body.samples.size(); k += 100) {
    EXPECT_LT((sensor.samples[k].dtheta - C_b_s * body.samples[k].dtheta).norm(), 1e-17);
    EXPECT_LT((sensor.samples[k].dv - C_b_s * body.samples[k].dv).norm(), 1e-15);
  }
}

TEST(TrueIncrements, EpochsOfARateThatIsNoWholeNanosecondsStayTrueToIt) {
  const AnalyticTrajectory truth = motion("city");
  const geo::GpsTime start = geo::GpsTime::from_week(2374, 208800.0);
  const record::ImuRecording recording = true_increments(truth, {start, 300.0, 1});
  ASSERT_EQ(recording.samples.size(), 310u * 300u);
  EXPECT_EQ(recording.samples.back().t, start + 310.0);
  double sum = 0.0;
  geo::GpsTime before = start;
  for (const record::ImuSample& sample : recording.samples) {
    EXPECT_NEAR(sample.t - before, sample.dt, 1e-15);
    before = sample.t;
    sum += sample.dt;
  }
  EXPECT_NEAR(sum, 310.0, 1e-9);
}

TEST(TrueIncrements, AreTheSameBytesOnAnyNumberOfThreads) {
  const AnalyticTrajectory truth = motion("ski");
  const record::ImuRecording one = true_increments(truth, {{}, 50.0, 5}, {}, 1);
  const record::ImuRecording three = true_increments(truth, {{}, 50.0, 5}, {}, 3);
  ASSERT_EQ(one.samples.size(), three.samples.size());
  for (std::size_t k = 0; k < one.samples.size(); ++k) {
    EXPECT_EQ(one.samples[k].t, three.samples[k].t);
    EXPECT_EQ(one.samples[k].dtheta, three.samples[k].dtheta);
    EXPECT_EQ(one.samples[k].dv, three.samples[k].dv);
  }
}

TEST(TrueStates, StandAtTheStartAndAtEverySample) {
  const AnalyticTrajectory truth = motion("survey_drone");
  const geo::GpsTime start = geo::GpsTime::from_week(2374, 208800.0);
  const record::ImuRecording recording = true_increments(truth, {start, 20.0, 1});
  const record::Trajectory states = true_states(truth, recording, start, 2);
  ASSERT_EQ(states.states.size(), recording.samples.size() + 1);
  EXPECT_EQ(states.states.front().t, start);
  for (std::size_t k = 0; k < recording.samples.size(); k += 37) {
    EXPECT_EQ(states.states[k + 1].t, recording.samples[k].t);
    const Kinematics expected = truth.at(0.05 * static_cast<double>(k + 1));
    EXPECT_LT((states.states[k + 1].r_eb_e - expected.r_eb_e).norm(), 2e-9);
    EXPECT_LT((states.states[k + 1].q_b_e.toRotationMatrix() - expected.C_b_e).norm(), 1e-12);  // t to an ulp of 310 s
  }
}

TEST(TrueIncrements, RefusesWhatItCannotSample) {
  const AnalyticTrajectory truth = motion("city");
  EXPECT_THROW((void)true_increments(truth, {{}, 0.0, 5}), std::invalid_argument);
  EXPECT_THROW((void)true_increments(truth, {{}, 100.0, 0}), std::invalid_argument);
  EXPECT_THROW((void)true_increments(truth, {{}, 100.0, 5}, {}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace coast::simulate
