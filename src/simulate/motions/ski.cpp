// A skier: runs with short swings of 2 to 3 Hz and strong roll, flat stops, and the lift back up.

#include "coast/geo/units.hpp"
#include "motions.hpp"

namespace coast::simulate {

using geo::kDegree;

namespace {

void lift(Drive& drive) {
  drive.speed_to(4.0, 4.0).slope_to(24.0, 8.0).turn(170.0, 9.0).cruise(92.0).slope_to(0.0, 8.0).turn(-165.0, 9.0);
}

}  // namespace

MotionPlan ski(const MotionParameters& parameters) {
  Drive drive(parameters);
  std::vector<Step> carving;
  drive.speed_to(3.0, 4.0).turn(60.0, 5.0).turn(-75.0, 5.0).speed_to(1.0, 3.0).speed_to(4.0, 4.0).turn(30.0, 4.0);
  for (int run = 0; drive.left(130.0) > 0.0; ++run) {
    const double start = drive.now();
    drive.speed_to(12.0, 6.0).slope_to(-14.0, 6.0);
    carving.push_back({drive.now(), 4.0, 1.0});
    drive.cruise(18.0).turn(35.0, 8.0).cruise(12.0).turn(-40.0, 8.0).cruise(10.0).name_since("run", start);
    carving.push_back({drive.now(), 4.0, -1.0});
    drive.slope_to(0.0, 5.0).cruise(6.0).stop(5.0, 4.0);
    if (drive.left(200.0) > 0.0) lift(drive);
  }
  if (drive.speed() > 0.0) drive.stop(4.0, 2.0);

  MotionPlan plan = drive.plan();
  plan.rule = {0.35, 0.0};
  const Steps swing(0.0, carving);
  plan.course =
      Signal(Steps(parameters.course, drive.course_steps()), swing, {{3.5 * kDegree, 2.3, 0.0}, {1.5 * kDegree, 0.61, 1.0}});
  plan.roll = Signal(Steps(), swing, {{15.0 * kDegree, 2.3, 1.57}, {5.0 * kDegree, 2.9, 0.2}});
  plan.pitch = Signal(Steps(), swing, {{6.0 * kDegree, 2.7, 0.9}, {2.0 * kDegree, 4.6, 0.0}});
  plan.yaw = Signal(Steps(), swing, {{5.0 * kDegree, 2.3, 0.4}});
  plan.down = Signal(Steps(), swing, {{0.05, 2.3, 0.3}, {0.008, 4.6, 1.1}});
  plan.right = Signal(Steps(), swing, {{0.03, 2.9, 0.0}});
  return plan;
}

}  // namespace coast::simulate
