#include "coast/study/comparison.hpp"

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::study {
namespace {

const geo::GpsTime kEpoch = geo::GpsTime::from_week(2374, 1000.0);

record::NavState standing(const geo::Geodetic& p, double s, const geo::Euler& attitude) {
  record::NavState nav;
  nav.t = kEpoch + s;
  nav.r_eb_e = geo::ecef_from_geodetic(p);
  nav.q_b_e = Eigen::Quaterniond(geo::C_n_e(p) * geo::dcm_from_euler(attitude));
  return nav;
}

TEST(Comparison, ErrorIsEstimateMinusReferenceInNorthEastDown) {
  const geo::Geodetic p{-0.6, 2.9, 120.0};
  const record::NavState reference = standing(p, 0.0, {0.0, 0.0, geo::kPi - 1e-3});
  record::TrajectoryEpoch estimate{standing(p, 0.0, {2e-3, -1e-3, -geo::kPi + 1e-3}), {}};
  const Eigen::Vector3d offset(1.0, 2.0, -3.0);
  estimate.nav.r_eb_e += geo::C_n_e(p) * offset;
  estimate.nav.v_eb_e = geo::C_n_e(p) * Eigen::Vector3d(0.1, 0.2, 0.3);
  const ErrorSample e = error_of(estimate, reference);
  EXPECT_LE((e.position_n - offset).norm(), 1e-8);  // rounding of ECEF
  EXPECT_LE((e.velocity_n - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  // Yaw wraps: -pi + 1e-3 against pi - 1e-3 is +2e-3. Euler angles are differences of the files' angles.
  EXPECT_NEAR(e.attitude.x(), 2e-3, 1e-10);
  EXPECT_NEAR(e.attitude.y(), -1e-3, 1e-10);
  EXPECT_NEAR(e.attitude.z(), 2e-3, 1e-10);
}

TEST(Comparison, TakesErrorsAtTheReferencesEpochsInTheOverlap) {
  const geo::Geodetic p{0.8, 0.1, 300.0};
  record::Trajectory reference;
  reference.has_velocity = false;
  for (const double s : {-1.0, 0.0, 0.35, 0.9, 1.0, 7.0}) reference.states.push_back(standing(p, s, {}));
  std::vector<ErrorSample> errors;
  Comparison comparison(reference, Eigen::Vector3d::Zero(), [&](const ErrorSample& e) { errors.push_back(e); });
  const Eigen::Vector3d v(2.0, -1.0, 0.5);
  for (int k = 0; k <= 10; ++k) {
    record::TrajectoryEpoch epoch{standing(p, 0.1 * k, {}), {}};
    epoch.nav.r_eb_e += geo::C_n_e(p) * v * (0.1 * k);
    epoch.nav.v_eb_e = geo::C_n_e(p) * v;
    comparison.add(epoch);
  }
  ASSERT_EQ(errors.size(), 4U);  // 0, 0.35, 0.9, 1.0
  EXPECT_LE((errors[1].position_n - 0.35 * v).norm(), 1e-8);
  const ErrorSummary s = comparison.summary();
  const double mean_square = (0.35 * 0.35 + 0.9 * 0.9 + 1.0) / 4.0;
  EXPECT_NEAR(s.position.rms.x(), 2.0 * std::sqrt(mean_square), 1e-8);
  EXPECT_NEAR(s.position.max.z(), 0.5, 1e-8);
  EXPECT_FALSE(s.velocity.has_value());
  EXPECT_TRUE(s.attitude.has_value());
  EXPECT_EQ(*s.position.inside_95, Eigen::Vector3d::Constant(0.25));  // without a sigma, only what has no error
}

TEST(Comparison, LeverArmGoesFromTheEstimatesPointToTheReferences) {
  const geo::Geodetic p{0.8, 0.1, 300.0};
  const geo::Euler east{0.0, 0.0, geo::kPi / 2.0};  // forward is east, right is south
  record::Trajectory reference;
  reference.states = {standing(p, 0.0, east)};
  ErrorSample error;
  Comparison comparison(reference, Eigen::Vector3d(1.0, 0.5, -0.25), [&](const ErrorSample& e) { error = e; });
  comparison.add({standing(p, 0.0, east), {}});
  EXPECT_LE((error.position_n - Eigen::Vector3d(-0.5, 1.0, -0.25)).norm(), 1e-8);
}

// A forward filter between two epochs of 100 Hz: its update moves the position by 2 cm, the velocity by 1 cm/s and the
// attitude by a tenth of a degree. The reference has an epoch in the middle.
TEST(Comparison, TakesNoVelocityFromTheStepOfAnUpdate) {
  const geo::Geodetic p{0.8, 0.1, 300.0};
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  const Eigen::Vector3d v(10.0, 5.0, 0.0), arm(1.0, 0.0, 0.0), wrong_by(0.01, 0.0, 0.0);
  record::Trajectory reference;
  for (int k = 0; k < 10; ++k) {
    record::NavState nav = standing(p, 0.005 + 0.01 * k, {});
    nav.r_eb_e += C_n_e * (v * (nav.t - kEpoch) + arm);
    nav.v_eb_e = C_n_e * v;
    reference.states.push_back(nav);
  }
  Comparison comparison(reference, arm);
  for (int k = 0; k <= 10; ++k) {
    const bool before = k < 5;
    record::TrajectoryEpoch epoch{standing(p, 0.01 * k, {0.0, 0.0, before ? 0.1 * geo::kDegree : 0.0}), {}};
    epoch.nav.r_eb_e += C_n_e * (v * (0.01 * k) + (before ? Eigen::Vector3d(0.0, 0.02, 0.0) : Eigen::Vector3d::Zero()));
    epoch.nav.v_eb_e = C_n_e * (before ? Eigen::Vector3d(v + wrong_by) : v);
    comparison.add(epoch);
  }
  const ErrorSummary s = comparison.summary();
  ASSERT_TRUE(s.velocity.has_value());
  EXPECT_LE(s.velocity->max.norm(), 0.01 + 1e-6);  // what the filter has, not 3 m/s from 2 cm and 0.2 m/s from the arm
}

}  // namespace
}  // namespace coast::study
