// A walker with the IMU on the body: steps at 1.8 Hz and motion of several degrees and centimetres at 5 to 10 Hz.

#include "coast/geo/units.hpp"
#include "motions.hpp"

namespace coast::simulate {

using geo::kDegree;

MotionPlan pedestrian(const MotionParameters& parameters) {
  Drive drive(parameters);
  drive.speed_to(1.3, 3.0).turn(80.0, 4.0).turn(-100.0, 4.0).speed_to(0.6, 2.0).speed_to(1.5, 2.0);
  const double walk = drive.now();
  for (int i = 0; drive.left(30.0) > 0.0; ++i) {
    drive.cruise(7.0 + 2.0 * (i % 4)).turn(i % 3 == 1 ? -75.0 : 90.0, 3.0);
    if (i % 8 == 5) drive.stop(2.0, 5.0).speed_to(1.4, 2.0);
  }
  drive.name_since("walk", walk).stop(2.0, 5.0);

  MotionPlan plan = drive.plan();
  const Steps gait = drive.envelope(1.4);
  plan.roll = Signal(Steps(), gait, {{2.5 * kDegree, 0.9, 0.0}, {2.5 * kDegree, 5.3, 0.7}, {1.2 * kDegree, 9.1, 0.2}});
  plan.pitch = Signal(Steps(), gait, {{2.0 * kDegree, 1.8, 1.0}, {2.2 * kDegree, 5.3, 2.2}, {1.0 * kDegree, 8.3, 1.5}});
  plan.yaw = Signal(Steps(), gait, {{4.0 * kDegree, 0.9, 0.5}, {1.5 * kDegree, 6.1, 0.0}});
  plan.down = Signal(Steps(), gait, {{0.025, 1.8, 0.4}, {0.008, 5.3, 1.2}, {0.002, 9.1, 0.0}});
  plan.right = Signal(Steps(), gait, {{0.020, 0.9, 1.1}, {0.004, 6.1, 0.3}});
  plan.ahead = Signal(Steps(), gait, {{0.015, 1.8, 2.0}, {0.005, 5.3, 0.0}});
  return plan;
}

}  // namespace coast::simulate
