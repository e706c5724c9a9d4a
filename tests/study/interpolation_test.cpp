#include "coast/study/interpolation.hpp"

#include <gtest/gtest.h>

#include "coast/geo/rotation.hpp"
#include "support/support.hpp"

namespace coast::study {
namespace {

const geo::GpsTime kStart = geo::GpsTime::from_week(2374, 1000.0);

// Position, velocity of a cubic in time, attitude at constant rate: what the interpolation has to reproduce exactly.
record::NavState cubic(double s) {
  const Eigen::Vector3d a(1.0, -2.0, 0.5);
  const Eigen::Vector3d b(3.0, 0.1, -1.0);
  const Eigen::Vector3d c(-0.2, 0.7, 0.3);
  record::NavState nav;
  nav.t = kStart + s;
  nav.r_eb_e = Eigen::Vector3d(4e6, 5e5, 4.9e6) + a * s + b * s * s + c * s * s * s;
  nav.v_eb_e = a + 2.0 * b * s + 3.0 * c * s * s;
  nav.q_b_e =
      Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5) * geo::quaternion_from_rotation_vector(Eigen::Vector3d(0.1, -0.3, 0.2) * s);
  return nav;
}

TEST(Interpolation, ReproducesACubicAndAConstantRate) {
  const record::NavState a = cubic(0.3);
  const record::NavState b = cubic(1.1);
  for (const double s : {0.3, 0.5, 0.77, 1.1}) {
    const record::NavState got = interpolate(a, b, kStart + s);
    const record::NavState want = cubic(s);
    EXPECT_LE((got.r_eb_e - want.r_eb_e).norm(), 1e-8);      // rounding of ECEF coordinates: 1e-9 m each
    EXPECT_LE((got.v_eb_e - want.v_eb_e).norm(), 1e-8);      // of their differences over the interval
    EXPECT_LE(got.q_b_e.angularDistance(want.q_b_e), 1e-7);  // acos near 1 loses half the digits
  }
}

TEST(Interpolation, RefusesToBridgeALongGap) {
  record::Trajectory trajectory;
  trajectory.states = {cubic(0.0), cubic(1.0), cubic(5.0)};
  EXPECT_TRUE(state_at(trajectory, kStart + 0.5).has_value());
  EXPECT_TRUE(state_at(trajectory, kStart + 5.0).has_value());
  EXPECT_FALSE(state_at(trajectory, kStart + 3.0, 2.0).has_value());
  EXPECT_FALSE(state_at(trajectory, kStart - 0.1).has_value());
  EXPECT_FALSE(state_at(trajectory, kStart + 5.1).has_value());
}

TEST(Interpolation, MovesToAnotherPointOfATurningBody) {
  record::NavState nav = cubic(0.0);
  const Eigen::Vector3d l_b(1.0, 2.0, 3.0);
  const Eigen::Vector3d omega(0.1, -0.3, 0.2);
  const record::NavState moved = at_point(nav, l_b, omega);
  // Velocity of the point by a difference quotient of its position along the constant rate.
  constexpr double kStep = 1e-3;
  const auto point = [&](double s) { return (cubic(s).r_eb_e + cubic(s).q_b_e * l_b).eval(); };
  const Eigen::Vector3d velocity = (point(kStep) - point(-kStep)) / (2.0 * kStep);
  EXPECT_LE((moved.r_eb_e - point(0.0)).norm(), 1e-9);
  EXPECT_LE((moved.v_eb_e - velocity).norm(), 1e-5);  // rounding 1e-9 m over the step, cubic term 1e-6
  EXPECT_LE((mean_rate(cubic(0.0), cubic(0.5)) - omega).norm(), 1e-12);
}

TEST(PassingMotion, IsThatOfTheIntervalThatEndsAndHoldsOverAnUpdate) {
  PassingMotion motion;
  EXPECT_TRUE(motion.at(cubic(0.0)).a_eb_b.isZero(0.0));
  const record::BodyMotion over = motion.at(cubic(0.01));
  // 2 b + 6 c s of the cubic in the middle of the interval, turned to the body there.
  const Eigen::Vector3d a_e = Eigen::Vector3d(6.0, 0.2, -2.0) + 6.0 * 0.005 * Eigen::Vector3d(-0.2, 0.7, 0.3);
  EXPECT_LE((over.a_eb_b - cubic(0.005).q_b_e.conjugate() * a_e).norm(), 1e-9);  // a mean of what is linear
  EXPECT_LE((over.omega_eb_b - Eigen::Vector3d(0.1, -0.3, 0.2)).norm(), 1e-9);
  record::NavState corrected = cubic(0.02);
  corrected.r_eb_e.x() += 0.5;
  corrected.v_eb_e.x() += 2.0;
  EXPECT_TRUE(motion.at(corrected).a_eb_b == over.a_eb_b);
}

}  // namespace
}  // namespace coast::study
