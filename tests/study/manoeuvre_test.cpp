#include "coast/study/manoeuvre.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"

namespace coast::study {
namespace {

const geo::GpsTime kDeparture = geo::GpsTime::from_week(2374, 1000.0);

/// A minute in the plane that touches the Earth at the start, 10 epochs a second; further than 3 km nobody gets, where it is
/// tilted by 5e-4 rad.
/// @param speed  m/s  @param course_deg  both of seconds since the start
record::Trajectory plane_drive(const std::function<double(double)>& speed, const std::function<double(double)>& course_deg) {
  constexpr double kStep = 0.1;
  const geo::Geodetic origin{0.8, 0.1, 400.0};
  const Eigen::Matrix3d C_n_e = geo::C_n_e(origin);
  const Eigen::Vector3d r_e = geo::ecef_from_geodetic(origin);
  const auto velocity = [&](double t) {
    const double course = geo::kDegree * course_deg(t);
    return (speed(t) * Eigen::Vector3d(std::cos(course), std::sin(course), 0.0)).eval();
  };
  record::Trajectory trajectory;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  for (int k = 0; k <= 600; ++k) {
    const double t = kStep * k;
    record::NavState nav;
    nav.t = kDeparture + t;
    nav.r_eb_e = r_e + C_n_e * moved;
    nav.v_eb_e = C_n_e * velocity(t);
    trajectory.states.push_back(nav);
    moved += kStep / 6.0 * (velocity(t) + 4.0 * velocity(t + 0.5 * kStep) + velocity(t + kStep));
  }
  return trajectory;
}

std::function<double(double)> steady(double value) {
  return [value](double) { return value; };
}
std::function<double(double)> changing(double from, double per_second) {
  return [from, per_second](double t) { return from + per_second * t; };
}

Manoeuvre between(const record::Trajectory& trajectory, double from, double to) {
  return manoeuvre_of(trajectory, kDeparture + from, kDeparture + to);
}

TEST(Manoeuvre, HasAName) {
  EXPECT_EQ(name(Manoeuvre::kStatic), "static");
  EXPECT_EQ(name(Manoeuvre::kStraight), "straight");
  EXPECT_EQ(name(Manoeuvre::kAccelerating), "accelerating");
  EXPECT_EQ(name(Manoeuvre::kTurn), "turn");
}

TEST(Manoeuvre, OfAParkedCar) {
  EXPECT_EQ(between(plane_drive(steady(0.0), steady(40.0)), 10.0, 40.0), Manoeuvre::kStatic);
  // What a reference wanders while it stands, turning about.
  EXPECT_EQ(between(plane_drive(steady(0.15), changing(0.0, 30.0)), 10.0, 40.0), Manoeuvre::kStatic);
  // Creeping is not standing, and its course says nothing.
  EXPECT_EQ(between(plane_drive(steady(0.3), changing(0.0, 30.0)), 10.0, 40.0), Manoeuvre::kStraight);
}

TEST(Manoeuvre, OfAStraightAndEvenDrive) {
  for (const double course : {0.0, 135.0, 180.0, 270.0})
    EXPECT_EQ(between(plane_drive(steady(20.0), steady(course)), 10.0, 40.0), Manoeuvre::kStraight) << course;
  EXPECT_EQ(between(plane_drive(changing(5.0, 0.4), steady(10.0)), 10.0, 40.0), Manoeuvre::kStraight);
  EXPECT_EQ(between(plane_drive(steady(20.0), changing(0.0, 2.9)), 10.0, 40.0), Manoeuvre::kStraight);
}

TEST(Manoeuvre, OfSpeedingUpAndBraking) {
  EXPECT_EQ(between(plane_drive(changing(5.0, 0.6), steady(10.0)), 10.0, 40.0), Manoeuvre::kAccelerating);
  EXPECT_EQ(between(plane_drive(changing(40.0, -0.6), steady(180.0)), 10.0, 40.0), Manoeuvre::kAccelerating);
  // Stop and go: 2 m/s^2 one way and the other, 3 s each, whose mean is nothing.
  const auto stop_and_go = [](double t) { return 6.0 + 2.0 * std::abs(std::fmod(t, 6.0) - 3.0); };
  EXPECT_EQ(between(plane_drive(stop_and_go, steady(10.0)), 10.0, 40.0), Manoeuvre::kAccelerating);
}

TEST(Manoeuvre, OfCircling) {
  for (const double rate : {3.1, -3.1, 20.0, -20.0})
    EXPECT_EQ(between(plane_drive(steady(10.0), changing(100.0, rate)), 10.0, 40.0), Manoeuvre::kTurn) << rate;
  // A slalom turns although its mean course does not; braking while circling is a turn first.
  const auto slalom = [](double t) { return 30.0 * std::sin(t); };
  EXPECT_EQ(between(plane_drive(steady(10.0), slalom), 10.0, 40.0), Manoeuvre::kTurn);
  EXPECT_EQ(between(plane_drive(changing(40.0, -0.6), changing(0.0, 10.0)), 10.0, 40.0), Manoeuvre::kTurn);
}

TEST(Manoeuvre, LeavesOutWhereTheReferenceHasNone) {
  // Straight north, a corner that nobody saw, straight east: neither the jump nor the corner counts.
  record::Trajectory trajectory = plane_drive(steady(20.0), [](double t) { return t < 25.0 ? 0.0 : 90.0; });
  EXPECT_EQ(between(trajectory, 20.0, 30.0), Manoeuvre::kTurn);
  std::erase_if(trajectory.states,
                [](const record::NavState& nav) { return nav.t > kDeparture + 22.0 && nav.t < kDeparture + 28.0; });
  EXPECT_EQ(between(trajectory, 20.0, 30.0), Manoeuvre::kStraight);
  EXPECT_EQ(between(trajectory, 22.5, 27.5), Manoeuvre::kStraight);                                  // nothing is left
  EXPECT_EQ(between(trajectory, 100.0, 130.0), Manoeuvre::kStraight);                                // nor was ever there
  EXPECT_EQ(between(plane_drive(steady(10.0), changing(0.0, 10.0)), 50.0, 80.0), Manoeuvre::kTurn);  // the end of it is missing
}

// One second has no change of anything within it: the seconds around it decide. What is further off does not.
TEST(Manoeuvre, OfOneSecond) {
  EXPECT_EQ(between(plane_drive(changing(40.0, -0.6), steady(0.0)), 20.0, 21.0), Manoeuvre::kAccelerating);
  EXPECT_EQ(between(plane_drive(steady(10.0), changing(0.0, 10.0)), 20.0, 21.0), Manoeuvre::kTurn);
  EXPECT_EQ(between(plane_drive(steady(0.0), steady(0.0)), 20.0, 21.0), Manoeuvre::kStatic);
  const auto departing = [](double t) { return std::max(0.0, t - 23.0); };
  EXPECT_EQ(between(plane_drive(departing, steady(0.0)), 20.0, 21.0), Manoeuvre::kStatic);
  EXPECT_EQ(between(plane_drive(departing, steady(0.0)), 23.0, 24.0), Manoeuvre::kAccelerating);
}

}  // namespace
}  // namespace coast::study
