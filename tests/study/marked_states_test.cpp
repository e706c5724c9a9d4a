#include "coast/study/marked_states.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::study {
namespace {

using record::MarkedState;

const geo::GpsTime kMarksStart = geo::GpsTime::from_week(2374, 1000.0);
const geo::Geodetic kCircleCentre{0.81, 0.115, 400.0};

/// Flies a circle of 50 m at 10 m/s about the vertical, level, and turns about its own axes once more.
record::TrajectoryEpoch circling(double s) {
  constexpr double kRadius = 50.0, kRate = 0.2;
  const double a = kRate * s;
  const Eigen::Matrix3d C_n_e = geo::C_n_e(kCircleCentre);
  record::TrajectoryEpoch epoch;
  epoch.nav.t = kMarksStart + s;
  epoch.nav.r_eb_e =
      geo::ecef_from_geodetic(kCircleCentre) + C_n_e * (kRadius * Eigen::Vector3d(std::sin(a), 1.0 - std::cos(a), 0.0));
  epoch.nav.v_eb_e = C_n_e * (kRadius * kRate * Eigen::Vector3d(std::cos(a), std::sin(a), 0.0));
  epoch.nav.q_b_e =
      Eigen::Quaterniond(C_n_e * geo::dcm_from_euler({0.0, 0.0, a}) * geo::rotation_matrix(Eigen::Vector3d(0.3, 0.1, 0.0) * s));
  epoch.cov = {Eigen::Vector3d(1e-4, 4e-4, 9e-4).asDiagonal(), Eigen::Matrix3d::Identity() * 1e-6,
               Eigen::Vector3d(1e-6, 2e-6, 5e-6).asDiagonal()};
  return epoch;
}

record::TimeMark mark_at(double s) {
  record::TimeMark mark;
  mark.t = kMarksStart + s;
  return mark;
}

MarkedStates passed(std::vector<record::TimeMark> marks, double delay_s = 0.0, const Mounted& mounted = {}) {
  MarkedStates states(std::move(marks), delay_s, mounted, 0.025);
  for (int i = 0; i <= 2000; ++i)
    if (i < 500 || i >= 600) states.add(circling(0.01 * i));  // a gap from 4.99 to 6 s
  states.finish();
  return states;
}

TEST(MarkedStates, AreThoseOfTheMotionBetweenTheEpochs) {
  Mounted mounted;
  mounted.lever_arm_b = {0.5, -0.2, 0.8};
  mounted.C_s_b = geo::dcm_from_euler({0.01, 0.4, -0.02});
  constexpr double kDelay = 0.0123;
  // The rate turns by 0.2 rad/s x 0.316 rad/s; between epochs 0.01 s apart it counts as constant: 0.0632 dt^2 / 8, and 5 %
  // more.
  constexpr double kTurn = 1.05 * 0.0632 * 1e-4 / 8.0;  // rad
  const MarkedStates states = passed({mark_at(1.0004), mark_at(1.0031), mark_at(17.5)}, kDelay, mounted);
  ASSERT_EQ(states.states().size(), 3U);
  EXPECT_TRUE(states.missed().empty());
  for (const MarkedState& state : states.states()) {
    const double s = state.mark.t - kMarksStart + kDelay;
    const auto point = [&](double at) {
      const record::NavState nav = circling(at).nav;
      return Eigen::Vector3d(nav.r_eb_e + nav.q_b_e * mounted.lever_arm_b);
    };
    constexpr double kStep = 1e-3;
    EXPECT_LT((state.nav.r_eb_e - point(s)).norm(), kTurn * mounted.lever_arm_b.norm());
    EXPECT_LT((state.nav.v_eb_e - (point(s + kStep) - point(s - kStep)) / (2.0 * kStep)).norm(), 2e-3);  // rate of the interval
    const Eigen::Matrix3d C_s_e = circling(s).nav.q_b_e.toRotationMatrix() * mounted.C_s_b;
    EXPECT_LT((state.nav.q_b_e.toRotationMatrix() - C_s_e).norm(), std::sqrt(2.0) * kTurn);
    EXPECT_NEAR(state.nav.t - kMarksStart, s, 1e-9);
  }
}

TEST(MarkedStates, OutsideAndInGapsAreMissedAndNotInvented) {
  const MarkedStates states =
      passed({mark_at(-0.5), mark_at(0.0), mark_at(4.99), mark_at(5.2), mark_at(6.0), mark_at(20.0), mark_at(20.001)});
  ASSERT_EQ(states.states().size(), 4U);
  for (const MarkedState& state : states.states())
    EXPECT_LT((state.nav.r_eb_e - circling(state.mark.t - kMarksStart).nav.r_eb_e).norm(), 1e-8);
  ASSERT_EQ(states.missed().size(), 3U);
  EXPECT_EQ(states.missed()[0].why, MissedMark::Why::kBefore);
  EXPECT_EQ(states.missed()[1].why, MissedMark::Why::kGap);
  EXPECT_EQ(states.missed()[2].why, MissedMark::Why::kAfter);
}

TEST(MarkedStates, CovarianceIsThatOfDrawnErrors) {
  Mounted mounted;
  mounted.lever_arm_b = {2.0, -1.0, 3.0};
  record::TimeMark mark = mark_at(3.004);
  mark.sd_s = 2e-3;
  const MarkedState state = passed({mark}, 0.0, mounted).states().front();
  const Eigen::Matrix3d C_e_n = geo::C_n_e(kCircleCentre).transpose();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto drawn = [&](const Eigen::Matrix3d& diagonal) {
    return Eigen::Vector3d(
        diagonal.diagonal().cwiseSqrt().cwiseProduct(Eigen::Vector3d(normal(random), normal(random), normal(random))));
  };
  const record::TrajectoryEpoch truth = circling(3.004);
  Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const record::TrajectoryEpoch late = circling(3.004 + mark.sd_s * normal(random));
    const Eigen::Vector3d arm_n = C_e_n * (late.nav.q_b_e * mounted.lever_arm_b);
    const Eigen::Vector3d r_n = C_e_n * (late.nav.r_eb_e - truth.nav.r_eb_e) + drawn(truth.cov.position) +
                                geo::rotation_matrix(drawn(truth.cov.attitude)) * arm_n -
                                C_e_n * (truth.nav.q_b_e * mounted.lever_arm_b);
    seen += r_n * r_n.transpose() / kDraws;
  }
  // Sample variances scatter by sqrt(2 / 40000) = 0.7 %.
  EXPECT_LT((state.cov.position - seen).norm(), 0.03 * seen.norm());
}

std::vector<MarkedState> with_positions(double delay_s, double sd_m, const Eigen::Vector3d& offset_n) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, sd_m);
  std::vector<MarkedState> states;
  for (int i = 0; i < 60; ++i) {
    MarkedState& state = states.emplace_back();
    state.nav = circling(0.31 * i).nav;
    const Eigen::Vector3d noise_n(normal(random), normal(random), normal(random));
    state.mark.r_e = circling(0.31 * i + delay_s).nav.r_eb_e + geo::C_n_e(kCircleCentre) * (offset_n + noise_n);
  }
  return states;
}

TEST(Delay, OfImagesIsSeenBesideAConstantOffset) {
  const auto found = estimate_delay(with_positions(0.04, 0.05, {1.5, -0.7, 30.0}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->marks, 60U);
  EXPECT_NEAR(found->sd_s, 0.05 / 10.0 / std::sqrt(60.0), 0.2 * found->sd_s);  // 10 m/s, 60 images
  EXPECT_NEAR(found->delay_s, 0.04, 4.0 * found->sd_s);
  EXPECT_NEAR(found->offset_n.x(), 1.5, 0.04);
  EXPECT_NEAR(found->offset_n.y(), -0.7, 0.04);
  EXPECT_NEAR(found->residual_m, 0.05, 0.012);
}

TEST(Delay, IsNotToldWhereItCannotBeKnown) {
  std::vector<MarkedState> states = with_positions(0.04, 0.05, Eigen::Vector3d::Zero());
  for (MarkedState& state : states) state.nav.v_eb_e = states.front().nav.v_eb_e;
  EXPECT_FALSE(estimate_delay(states));  // straight on: an offset as well
  states.resize(3);
  EXPECT_FALSE(estimate_delay(states));
}

}  // namespace
}  // namespace coast::study
