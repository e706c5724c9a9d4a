// A survey aircraft: taxi, take-off, climb, photogrammetric lines joined by 45 degree banked turns, descent and landing.

#include <algorithm>
#include <cmath>

#include "coast/geo/units.hpp"
#include "motions.hpp"

namespace coast::simulate {
namespace {

using geo::kDegree;
constexpr double kSpeed = 60.0;                                            // m/s
constexpr double kTurnRateDeg = geo::kStandardGravity / kSpeed / kDegree;  // deg/s at 45 degrees of bank
constexpr double kClimbSlope = 6.0;                                        // deg
constexpr double kClimbSeconds = 60.0;
constexpr double kDescentSlope = 4.0;  // deg

void half_turn(Drive& drive, double degrees) {
  drive.circle(degrees, std::abs(degrees) / kTurnRateDeg);
}

}  // namespace

MotionPlan aircraft_lines(const MotionParameters& parameters) {
  // On average the same height down as up: slope times time at the same speed.
  const double descent = kClimbSeconds * std::sin(kClimbSlope * kDegree) / std::sin(kDescentSlope * kDegree);
  Drive drive(parameters);
  drive.speed_to(4.0, 5.0)
      .cruise(7.0)
      .turn(90.0, 14.0)
      .turn(-80.0, 13.0)
      .speed_to(6.0, 4.0)
      .speed_to(3.0, 4.0)
      .turn(80.0, 12.0)
      .stop(5.0, 3.0);
  drive.speed_to(kSpeed, 26.0).slope_to(kClimbSlope, 6.0).cruise(kClimbSeconds).slope_to(0.0, 6.0).cruise(8.0);
  half_turn(drive, 120.0);
  half_turn(drive, -120.0);
  const double survey = drive.now();
  for (int i = 0; drive.left(descent + 110.0) > 0.0; ++i) {
    drive.cruise(35.0);
    half_turn(drive, i % 2 == 0 ? 180.0 : -180.0);
  }
  drive.name_since("lines", survey);
  drive.cruise(6.0).slope_to(-kDescentSlope, 6.0).cruise(descent).slope_to(0.0, 6.0).cruise(8.0).stop(20.0, 5.0);

  MotionPlan plan = drive.plan();
  plan.rule = {1.0, 0.15};
  const Steps flight = drive.envelope(kSpeed);
  plan.roll = Signal(Steps(), flight, {{1.2 * kDegree, 0.31, 0.0}, {0.3 * kDegree, 1.7, 0.8}, {0.03 * kDegree, 9.3, 0.2}});
  plan.pitch = Signal(Steps(), flight, {{0.6 * kDegree, 0.07, 0.5}, {0.2 * kDegree, 1.3, 1.9}, {0.03 * kDegree, 8.7, 0.0}});
  plan.yaw = Signal(Steps(), flight, {{0.9 * kDegree, 0.31, 1.5}});
  plan.down = Signal(Steps(), flight, {{1.5, 0.07, 2.0}, {0.05, 0.9, 0.0}, {0.0005, 11.0, 0.0}});
  plan.right = Signal(Steps(), flight, {{0.8, 0.11, 0.0}});
  return plan;
}

}  // namespace coast::simulate
