// A multicopter: take-off, figures to align, parallel survey lines; it tilts to accelerate and sways in the wind.

#include "coast/geo/units.hpp"
#include "motions.hpp"

namespace coast::simulate {
namespace {

using geo::kDegree;

// To the next line, 25 m from the last, and back along it.
void line(Drive& drive, bool to_the_right) {
  const double side = to_the_right ? 90.0 : -90.0;
  drive.speed_to(9.0, 5.0).cruise(22.0).speed_to(3.0, 4.0);
  drive.turn(side, 4.0).cruise(4.0).turn(side, 4.0);
}

}  // namespace

MotionPlan survey_drone(const MotionParameters& parameters) {
  constexpr double kClimb = 25.0;   // s
  constexpr double kHeight = 60.0;  // m
  Drive drive(parameters);
  drive.cruise(Steps::reach(kClimb));
  const double take_off = drive.now();
  drive.cruise(kClimb);
  drive.speed_to(6.0, 4.0).turn(160.0, 9.0).turn(-170.0, 9.0).speed_to(0.0, 4.0).speed_to(7.0, 4.0).turn(60.0, 4.0);
  const double survey = drive.now();
  for (int i = 0; drive.left(kClimb + 55.0) > 0.0; ++i) line(drive, i % 2 == 0);
  drive.name_since("lines", survey).stop(5.0, 0.0);
  const double landing = drive.now();

  MotionPlan plan = drive.plan();
  plan.rule = {1.0, -1.0};
  const Steps airborne(0.0, {{take_off + 8.0, 5.0, 1.0}, {landing + kClimb - 12.0, 5.0, -1.0}});
  const Steps height(0.0, {{take_off, kClimb, -kHeight}, {landing, kClimb, kHeight}});
  plan.down = Signal(height, airborne, {{0.08, 0.23, 0.0}, {0.004, 3.1, 1.0}});
  plan.right = Signal(Steps(), airborne, {{0.15, 0.37, 0.4}});
  plan.ahead = Signal(Steps(), airborne, {{0.12, 0.29, 1.3}});
  plan.roll = Signal(Steps(), airborne, {{1.2 * kDegree, 0.37, 0.4}, {0.6 * kDegree, 1.9, 2.2}, {0.15 * kDegree, 7.3, 0.1}});
  plan.pitch = Signal(Steps(), airborne, {{1.0 * kDegree, 0.29, 1.3}, {0.5 * kDegree, 2.3, 0.6}, {0.15 * kDegree, 8.1, 1.7}});
  plan.yaw = Signal(Steps(), airborne, {{2.0 * kDegree, 0.13, 0.9}, {0.3 * kDegree, 1.1, 0.0}});
  return plan;
}

}  // namespace coast::simulate
