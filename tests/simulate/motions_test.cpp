#include "coast/simulate/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::simulate {
namespace {

using Eigen::Vector3d;
using geo::kDegree;

class EveryKind : public ::testing::TestWithParam<MotionKind> {
 protected:
  static AnalyticTrajectory motion(double duration, double static_start = 45.0) {
    MotionParameters parameters;
    parameters.origin = {46.52 * kDegree, 6.57 * kDegree, 400.0};
    parameters.duration = duration;
    parameters.static_start = static_start;
    return make_motion(GetParam().name, parameters);
  }
};

TEST_P(EveryKind, WorksFromItsShortestToAnHour) {
  for (double duration : {GetParam().shortest + 45.0, 645.0, 3600.0}) {
    const AnalyticTrajectory truth = motion(duration);
    EXPECT_EQ(truth.duration(), duration);
    EXPECT_FALSE(truth.plan().manoeuvres.empty()) << duration;
    for (const Manoeuvre& m : truth.plan().manoeuvres) {
      EXPECT_GE(m.start, 45.0);
      EXPECT_GT(m.duration, 0.0);
      EXPECT_LE(m.start + m.duration, duration);
    }
    EXPECT_LT(truth.at(duration).v_eb_e.norm(), 1e-3) << "ends at rest";
  }
  EXPECT_THROW((void)motion(GetParam().shortest + 44.0), std::invalid_argument);
  EXPECT_THROW((void)motion(2e5), std::invalid_argument);
  EXPECT_THROW((void)motion(900.0, -1.0), std::invalid_argument);
}

// A body at rest must not turn: a stop is what zero-velocity and zero-rate updates rely on.
TEST_P(EveryKind, DoesNotTurnAtStandstill) {
  const AnalyticTrajectory truth = motion(900.0);
  for (double t = 0.0; t < 900.0; t += 0.25) {
    const Kinematics k = truth.at(t);
    if (k.v_eb_e.norm() < 1e-6 && k.a_eb_e.norm() < 1e-6) {
      EXPECT_LT(k.omega_eb_b.norm(), 1e-4) << t;
    }
  }
}

// Excitation for the alignment: within two minutes of the start the course and the speed have changed strongly, both ways.
TEST_P(EveryKind, ExcitesBeforeTheFirstManoeuvre) {
  const AnalyticTrajectory truth = motion(900.0);
  if (GetParam().name == "at_rest") {
    for (double t = 0.0; t <= 900.0; t += 10.0) EXPECT_EQ(truth.plan().speed.at(t).value(), 0.0);
    return;
  }
  double left = 0.0;
  double right = 0.0;
  double faster = 0.0;
  double slower = 0.0;
  for (double t = 45.0; t < truth.plan().manoeuvres.front().start; t += 0.1) {
    const double turn_rate = truth.plan().course.at(t).derivative(1);
    const double acceleration = truth.plan().speed.at(t).derivative(1);
    right += 0.1 * std::max(0.0, turn_rate);
    left += 0.1 * std::max(0.0, -turn_rate);
    faster = std::max(faster, acceleration);
    slower = std::max(slower, -acceleration);
  }
  EXPECT_GT(right, 60.0 * kDegree);
  EXPECT_GT(left, 60.0 * kDegree);
  EXPECT_GT(faster, 0.4);
  EXPECT_GT(slower, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Simulate, EveryKind, ::testing::ValuesIn(motions()),
                         [](const auto& test) { return std::string(test.param.name); });

// Largest size of something over the motion after 60 s.
template <typename Function>
double largest(const AnalyticTrajectory& truth, const Function& f) {
  double value = 0.0;
  for (double t = 60.0; t < truth.duration(); t += 0.05) value = std::max(value, std::abs(f(truth.at(t))));
  return value;
}

MotionParameters parameters() {
  MotionParameters p;
  p.origin = {46.52 * kDegree, 6.57 * kDegree, 400.0};
  return p;
}

double roll_of(const Kinematics& k) {
  return geo::euler_from_dcm(geo::C_n_e(geo::geodetic_from_ecef(k.r_eb_e)).transpose() * k.C_b_e).roll;
}

TEST(Cars, StayWithinWhatTyresHold) {
  for (const char* kind : {"car_roundabout", "car_straight", "city"}) {
    const AnalyticTrajectory truth = make_motion(kind, parameters());
    const auto horizontal = [](const Kinematics& k) {
      const Vector3d a_b = k.C_b_e.transpose() * k.a_eb_e;
      return std::hypot(a_b.x(), a_b.y());
    };
    EXPECT_LT(largest(truth, horizontal), 6.0) << kind;
    EXPECT_GT(largest(truth, horizontal), 2.0) << kind;
    EXPECT_LT(largest(truth, roll_of), 4.0 * kDegree) << kind;
    EXPECT_LT(largest(truth, [](const Kinematics& k) { return (k.C_b_e.transpose() * k.v_eb_e).y(); }), 0.15) << kind;
  }
}

TEST(CarRoundabout, CirclesOnceAndAHalfInTwentySeconds) {
  const AnalyticTrajectory truth = make_motion("car_roundabout", parameters());
  const Manoeuvre circle = truth.plan().manoeuvres.front();
  EXPECT_EQ(circle.name, "roundabout");
  const auto course = [&](double t) { return truth.plan().course.at(t).value(); };
  EXPECT_NEAR(course(circle.start + 20.0) - course(circle.start), -1.5 * 360.0 * kDegree, 40.0 * kDegree);
  // In its middle the turn rate is constant and the radius about 15 m.
  const SignalJet psi = truth.plan().course.at(circle.start + 10.5);
  EXPECT_LT(std::abs(psi.derivative(2)), 1e-6);
  EXPECT_NEAR(truth.plan().speed.at(circle.start + 10.5).value() / std::abs(psi.derivative(1)), 15.0, 1.0);
}

TEST(CarStraight, HoldsItsCourseForLongerThanTheOutage) {
  const AnalyticTrajectory truth = make_motion("car_straight", parameters());
  const Manoeuvre straight = truth.plan().manoeuvres.front();
  EXPECT_GT(straight.duration, 400.0);
  const double course = truth.plan().course.at(straight.start + 8.0).value();
  double slowest = 1e9;
  double fastest = 0.0;
  for (double t = straight.start + 8.0; t < straight.start + straight.duration; t += 0.5) {
    EXPECT_LT(std::abs(truth.plan().course.at(t).value() - course), 6.0 * kDegree);
    slowest = std::min(slowest, truth.plan().speed.at(t).value());
    fastest = std::max(fastest, truth.plan().speed.at(t).value());
  }
  EXPECT_LT(slowest, 5.1);
  EXPECT_GT(fastest, 29.0);
}

TEST(Vehicles, LeanAsTheyDo) {
  EXPECT_NEAR(largest(make_motion("aircraft_lines", parameters()), roll_of), 45.0 * kDegree, 3.0 * kDegree);
  EXPECT_GT(largest(make_motion("ski", parameters()), roll_of), 30.0 * kDegree);
  EXPECT_GT(largest(make_motion("boat", parameters()), roll_of), 10.0 * kDegree);
  EXPECT_GT(largest(make_motion("survey_drone", parameters()), roll_of), 10.0 * kDegree);
  EXPECT_GT(largest(make_motion("pedestrian", parameters()), roll_of), 4.0 * kDegree);
}

// In a coordinated turn the specific force has no lateral component.
TEST(Aircraft, BanksIntoItsTurns) {
  MotionPlan plan = make_motion("aircraft_lines", parameters()).plan();
  plan.roll = plan.pitch = plan.yaw = plan.down = plan.right = Signal();
  plan.rule.lift = 0.0;
  const AnalyticTrajectory truth(plan);
  const Manoeuvre lines = truth.plan().manoeuvres.front();
  for (double t = lines.start; t < lines.start + lines.duration; t += 0.5) {
    // g of the rule against g of the place, and Coriolis: 2 omega v = 0.009 m/s^2
    EXPECT_LT(std::abs(f_ib_b(truth.at(t)).y()), 0.03) << t;
  }
}

TEST(Motions, UnknownNameIsRefused) {
  EXPECT_THROW((void)make_motion("submarine", parameters()), std::invalid_argument);
}

}  // namespace
}  // namespace coast::simulate
