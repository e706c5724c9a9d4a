#include "coast/simulate/trajectory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "differences.hpp"

namespace coast::simulate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geo::kDegree;
using test::derivative;

constexpr double kStep = 0.004;  // s: (2 pi 9 Hz h)^8 / 630 = 1e-8 of the fastest motion

// Angle of the Earth since t = 0: everything below is in inertial axes, so Coriolis and centrifugal terms do not occur.
Matrix3d C_e_i(double t) {
  return Eigen::AngleAxisd(geo::kEarthRate * t, Vector3d::UnitZ()).toRotationMatrix();
}

struct Case {
  std::string_view kind;
  test::Place place;
};

class EveryMotion : public ::testing::TestWithParam<Case> {
 protected:
  static AnalyticTrajectory motion() {
    MotionParameters parameters;
    parameters.origin = GetParam().place.origin;
    parameters.duration = 620.0;
    parameters.static_start = 30.0;
    parameters.course = 0.7;
    return make_motion(GetParam().kind, parameters);
  }
};

TEST_P(EveryMotion, VelocityIsTheDerivativeOfPosition) {
  const AnalyticTrajectory truth = motion();
  for (double t = 1.0; t < 619.0; t += 0.731) {
    const Vector3d v = derivative([&](double s) -> Vector3d { return truth.at(s).r_eb_e; }, t, kStep);
    // 1e-9 m of rounding of ECEF coordinates over h
    EXPECT_LT((v - truth.at(t).v_eb_e).norm(), 1e-6) << t;
  }
}

TEST_P(EveryMotion, SpecificForceIsInertialAccelerationMinusGravitation) {
  const AnalyticTrajectory truth = motion();
  const auto inertial_velocity = [&](double t) -> Vector3d {
    const Kinematics k = truth.at(t);
    return C_e_i(t) * (k.v_eb_e + geo::kEarthRate * Vector3d(-k.r_eb_e.y(), k.r_eb_e.x(), 0.0));
  };
  for (double t = 1.0; t < 619.0; t += 0.731) {
    const Kinematics k = truth.at(t);
    const Vector3d centrifugal = geo::kEarthRate * geo::kEarthRate * Vector3d(k.r_eb_e.x(), k.r_eb_e.y(), 0.0);
    const Vector3d gravitation_i = C_e_i(t) * (geo::gravity_e(k.r_eb_e) - centrifugal);
    const Vector3d f_i = derivative(inertial_velocity, t, kStep) - gravitation_i;
    // truncation 1e-8 of up to 30 m/s^2, rounding 1e-13 m/s over h
    EXPECT_LT((C_e_i(t) * k.C_b_e * f_ib_b(k) - f_i).norm(), 1e-6) << t;
  }
}

TEST_P(EveryMotion, RateIsTheDerivativeOfAttitudeAgainstInertialSpace) {
  const AnalyticTrajectory truth = motion();
  for (double t = 1.0; t < 619.0; t += 0.731) {
    const Kinematics k = truth.at(t);
    const Matrix3d dC = derivative([&](double s) -> Matrix3d { return C_e_i(s) * truth.at(s).C_b_e; }, t, kStep);
    const Matrix3d W = (C_e_i(t) * k.C_b_e).transpose() * dC;
    const Vector3d omega(W(2, 1), W(0, 2), W(1, 0));
    EXPECT_LT((omega - omega_ib_b(k)).norm(), 2e-6) << t;
    const Vector3d alpha = derivative([&](double s) -> Vector3d { return truth.at(s).omega_eb_b; }, t, kStep);
    EXPECT_LT((alpha - k.alpha_eb_b).norm(), 2e-5) << t;  // 1e-8 of up to 200 rad/s^2, and products of tones
  }
}

TEST_P(EveryMotion, AttitudeIsARotation) {
  const AnalyticTrajectory truth = motion();
  for (double t = 0.0; t < 620.0; t += 3.7) {
    const Matrix3d C = truth.at(t).C_b_e;
    EXPECT_LT((C * C.transpose() - Matrix3d::Identity()).norm(), 4e-15);
    EXPECT_GT(C.determinant(), 0.0);
  }
}

TEST_P(EveryMotion, StartsExactlyAtRest) {
  const AnalyticTrajectory truth = motion();
  for (double t = 0.0; t <= 30.0; t += 1.5) {
    const Kinematics k = truth.at(t);
    EXPECT_LT((k.r_eb_e - truth.at(0.0).r_eb_e).norm(), 1e-20);
    EXPECT_LT(k.v_eb_e.norm(), 1e-16);
    EXPECT_LT(k.omega_eb_b.norm(), 1e-16);
  }
  EXPECT_LT((truth.at(0.0).r_eb_e - geo::ecef_from_geodetic(GetParam().place.origin)).norm(), 2e-9);
}

// The position comes from a table of series: neighbours must agree where they meet, and so must all derivatives.
TEST_P(EveryMotion, PositionIsContinuousWhereSegmentsMeet) {
  const AnalyticTrajectory truth = motion();
  constexpr double kEps = 1e-9;
  for (double joint = 0.25; joint < 619.0; joint += 0.25) {
    const Kinematics before = truth.at(joint - kEps);
    const Kinematics after = truth.at(joint + kEps);
    EXPECT_LT((after.r_eb_e - before.r_eb_e - 2.0 * kEps * before.v_eb_e).norm(), 4e-9) << joint;  // rounding of ECEF
    EXPECT_LT((after.v_eb_e - before.v_eb_e).norm(), 2.0 * kEps * 60.0) << joint;
    EXPECT_LT((after.a_eb_e - before.a_eb_e).norm(), 2.0 * kEps * 5e3) << joint;
    EXPECT_LT((after.omega_eb_b - before.omega_eb_b).norm(), 2.0 * kEps * 500.0) << joint;
    EXPECT_LT((after.alpha_eb_b - before.alpha_eb_b).norm(), 2.0 * kEps * 2e4) << joint;
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const std::vector<test::Place> places = test::places();
  for (std::size_t i = 0; i < motions().size(); ++i) all.push_back({motions()[i].name, places[i % places.size()]});
  for (const test::Place& place : places) all.push_back({"aircraft_lines", place});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Simulate, EveryMotion, ::testing::ValuesIn(cases()), [](const auto& test) {
  return std::string(test.param.kind) + "_" + test.param.place.name + "_" + std::to_string(test.index);
});

MotionPlan straight_plan(const geo::Geodetic& origin, double speed, double course) {
  MotionPlan plan;
  plan.origin = origin;
  plan.duration = 1000.0;
  plan.speed = Steps(speed);
  plan.course = Steps(course);
  return plan;
}

// Stereographic projection from a sphere: a tangent-plane distance d is the central angle 2 atan(d / 2R).
TEST(Path, StraightNorthIsAGreatCircleOfTheTouchingSphere) {
  const geo::Geodetic origin{46.52 * kDegree, 6.57 * kDegree, 400.0};
  const AnalyticTrajectory truth(straight_plan(origin, 100.0, 0.0));
  const double d = 100.0 * (700.0 + 1.0);  // the path begins one second before t = 0
  const geo::Radii radii = geo::radii_of_curvature(origin.latitude);
  const double radius = std::sqrt(radii.meridian * radii.prime_vertical) + origin.height;
  const double angle = 2.0 * std::atan(d / (2.0 * radius));
  const Vector3d ned(radius * std::sin(angle), 0.0, radius * (1.0 - std::cos(angle)));
  const Vector3d expected = geo::ecef_from_geodetic(origin) + geo::C_n_e(origin) * ned;
  EXPECT_LT((truth.at(700.0).r_eb_e - expected).norm(), 1e-8);  // 700 sums of rounding at 7e4 m
  // The sphere leaves the ellipsoid slowly: half the difference of curvatures times d^2 is 4 m at 70 km.
  EXPECT_NEAR(geo::geodetic_from_ecef(truth.at(700.0).r_eb_e).height, 400.0, 4.0);
}

TEST(Path, VelocityPointsAlongTheBodyFarFromTheOrigin) {
  for (const test::Place& place : test::places()) {
    const AnalyticTrajectory truth(straight_plan(place.origin, 60.0, 1.1));
    const Kinematics k = truth.at(990.0);
    const Vector3d v_eb_b = k.C_b_e.transpose() * k.v_eb_e;
    EXPECT_LT(std::hypot(v_eb_b.y(), v_eb_b.z()), 1e-12 * v_eb_b.x()) << place.name;  // conformal: rounding only
  }
}

// At 200 km from the origin the path axes turn about all three axes, by up to 4e-5 rad/s; slow enough for a step of 0.5 s.
TEST(Path, RateOfThePathAxesIsExactFarFromTheOrigin) {
  MotionPlan plan = straight_plan({46.52 * kDegree, 6.57 * kDegree, 400.0}, 250.0, 0.4);
  plan.course = Steps(0.4, {{300.0, 400.0, 2.0}});
  const AnalyticTrajectory truth(plan);
  for (double t = 500.0; t < 990.0; t += 13.0) {
    const Matrix3d dC = derivative([&](double s) -> Matrix3d { return truth.at(s).C_b_e; }, t, 0.5);
    const Matrix3d W = truth.at(t).C_b_e.transpose() * dC;
    // rounding 4e-16 over h; the vertical rate alone is 1e-6 rad/s
    EXPECT_LT((Vector3d(W(2, 1), W(0, 2), W(1, 0)) - truth.at(t).omega_eb_b).norm(), 1e-14) << t;
  }
}

TEST(Path, LeverArmPointMovesAsItsPositionDoes) {
  MotionParameters parameters;
  parameters.origin = {46.52 * kDegree, 6.57 * kDegree, 400.0};
  const AnalyticTrajectory truth = make_motion("boat", parameters);
  const Vector3d l_b(3.0, -1.0, -6.0);
  for (double t = 150.0; t < 800.0; t += 7.3) {
    const Kinematics p = at_point(truth.at(t), l_b);
    const auto position = [&](double s) -> Vector3d { return truth.at(s).r_eb_e + truth.at(s).C_b_e * l_b; };
    const auto velocity = [&](double s) -> Vector3d { return at_point(truth.at(s), l_b).v_eb_e; };
    EXPECT_LT((derivative(position, t, kStep) - p.v_eb_e).norm(), 1e-6);
    EXPECT_LT((derivative(velocity, t, kStep) - p.a_eb_e).norm(), 1e-9);
  }
}

TEST(AnalyticTrajectory, RefusesTimesOutsideAndBadDurations) {
  const AnalyticTrajectory truth(straight_plan({}, 1.0, 0.0));
  EXPECT_THROW((void)truth.at(-1.1), std::invalid_argument);
  EXPECT_THROW((void)truth.at(1001.1), std::invalid_argument);
  EXPECT_THROW((void)truth.at(std::nan("")), std::invalid_argument);
  MotionPlan endless = straight_plan({}, 1.0, 0.0);
  endless.duration = 3e5;
  EXPECT_THROW(AnalyticTrajectory{endless}, std::invalid_argument);
}

}  // namespace
}  // namespace coast::simulate
