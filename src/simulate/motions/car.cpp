// Three cars: a roundabout in the city, a straight road with strongly varying acceleration, and streets with stops.

#include <algorithm>
#include <array>

#include "coast/geo/units.hpp"
#include "motions.hpp"

namespace coast::simulate {
namespace {

using geo::kDegree;

// The body leans outward in turns, squats and dives, and vibrates with the road in proportion to speed.
MotionPlan car(const Drive& drive) {
  const Steps shaking = drive.envelope(15.0);
  MotionPlan plan = drive.plan();
  plan.rule = {-0.06, 0.04};
  plan.roll = Signal(Steps(), shaking, {{0.45 * kDegree, 0.11, 0.3}, {0.25 * kDegree, 1.37, 1.1}, {0.08 * kDegree, 4.3, 0.0}});
  plan.pitch = Signal(Steps(), shaking, {{0.20 * kDegree, 1.61, 0.7}, {0.06 * kDegree, 5.1, 2.0}});
  plan.yaw = Signal(Steps(), shaking, {{0.10 * kDegree, 0.83, 0.2}});
  plan.down = Signal(Steps(), shaking, {{0.012, 1.53, 0.5}, {0.001, 6.7, 1.4}});
  return plan;
}

void block(Drive& drive, int number) {
  constexpr std::array<double, 6> kSpeeds = {13.0, 11.0, 14.0, 9.0, 12.5, 10.0};
  constexpr std::array<double, 6> kGrades = {1.5, -1.0, 0.5, -2.0, 1.2, -0.2};
  const auto i = static_cast<std::size_t>(number) % kSpeeds.size();
  drive.speed_to(kSpeeds[i], 7.0).slope_to(kGrades[i], 8.0).cruise(9.0).speed_to(6.0, 6.0);
  drive.turn(number % 5 == 3 ? -90.0 : 90.0, 6.0);
}

void end_at_rest(Drive& drive) {
  const double braking = std::max(4.0, 0.8 * drive.speed());  // 3 m/s^2
  const double needed = braking + Steps::reach(braking) + 15.0;
  if (drive.left(needed) > 0.0) drive.cruise(drive.left(needed));
  drive.stop(braking, 2.0);
}

// Entry from the right, one and a half times counter-clockwise on a radius of about 15 m, and exit to the right.
void roundabout(Drive& drive) {
  drive.speed_to(7.0, 4.0).turn(50.0, 3.0);
  const double start = drive.now();
  drive.circle(-560.0, 21.0).name_since("roundabout", start);
  drive.turn(50.0, 3.0);
}

}  // namespace

MotionPlan car_roundabout(const MotionParameters& parameters) {
  Drive drive(parameters);
  alignment_drive(drive, 10.0);
  for (int i = 0; drive.left(80.0) > 0.0; ++i) {
    block(drive, i);
    if (i % 6 == 1) roundabout(drive);
  }
  end_at_rest(drive);
  return car(drive);
}

MotionPlan car_straight(const MotionParameters& parameters) {
  constexpr std::array<double, 10> kSpeeds = {22.0, 8.0, 26.0, 14.0, 30.0, 19.0, 25.0, 5.0, 28.0, 12.0};
  constexpr std::array<double, 10> kSeconds = {9.0, 8.5, 11.0, 7.0, 12.0, 7.0, 5.0, 11.0, 13.0, 9.0};
  constexpr std::array<double, 10> kBends = {1.5, -2.0, 0.8, 1.7, -2.5, 0.6, -1.1, 2.2, -1.9, 0.7};
  Drive drive(parameters);
  alignment_drive(drive, 12.0);
  block(drive, 0);
  block(drive, 1);
  const double start = drive.now();
  for (std::size_t i = 0; drive.left(90.0) > 0.0; i = (i + 1) % kSpeeds.size()) {
    drive.speed_to(kSpeeds[i], kSeconds[i]).slope_to(0.4 * kBends[i], 6.0).turn(kBends[i], 5.0);
    if (i == 7) drive.stop(5.0, 2.0);
  }
  drive.name_since("straight", start);
  end_at_rest(drive);
  return car(drive);
}

MotionPlan city(const MotionParameters& parameters) {
  Drive drive(parameters);
  alignment_drive(drive, 9.0);
  const double start = drive.now();
  for (int i = 0; drive.left(80.0) > 0.0; ++i) {
    block(drive, i);
    if (i % 2 == 1) drive.stop(5.0, 4.0 + 7.0 * (i % 3));
    if (i % 7 == 4) drive.speed_to(3.0, 3.0).turn(175.0, 9.0);
  }
  drive.name_since("streets", start);
  end_at_rest(drive);
  return car(drive);
}

}  // namespace coast::simulate
