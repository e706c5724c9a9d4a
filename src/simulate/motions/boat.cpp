// A survey boat: still in the harbour, then in swell and chop with slow turns.

#include "coast/geo/units.hpp"
#include "motions.hpp"

namespace coast::simulate {

using geo::kDegree;

MotionPlan boat(const MotionParameters& parameters) {
  Drive drive(parameters);
  drive.speed_to(3.0, 8.0).turn(70.0, 12.0).turn(-90.0, 12.0).speed_to(1.0, 6.0).speed_to(5.0, 8.0);
  const double sea = drive.now();
  for (int i = 0; drive.left(75.0) > 0.0; ++i) {
    drive.cruise(18.0).turn(i % 3 == 2 ? -130.0 : 80.0, 14.0);
    if (i % 2 == 1) drive.speed_to(i % 4 == 1 ? 3.0 : 6.0, 7.0);
  }
  drive.name_since("swell", sea);
  const double harbour = drive.now();
  drive.cruise(25.0).stop(8.0, 5.0);

  MotionPlan plan = drive.plan();
  plan.rule = {0.25, 0.2};
  const Steps waves(0.0, {{sea - 20.0, 15.0, 1.0}, {harbour + 5.0, 15.0, -1.0}});
  plan.roll = Signal(Steps(), waves, {{9.0 * kDegree, 0.137, 0.0}, {4.0 * kDegree, 0.313, 1.0}, {1.0 * kDegree, 1.17, 0.3}});
  plan.pitch = Signal(Steps(), waves, {{4.5 * kDegree, 0.171, 0.8}, {2.0 * kDegree, 0.389, 2.1}, {0.8 * kDegree, 1.31, 1.1}});
  plan.yaw = Signal(Steps(), waves, {{2.5 * kDegree, 0.151, 1.9}, {0.5 * kDegree, 0.71, 0.4}});
  plan.down = Signal(Steps(), waves, {{0.60, 0.149, 0.5}, {0.15, 0.353, 0.0}, {0.02, 1.21, 1.6}});
  plan.ahead = Signal(Steps(), waves, {{0.30, 0.163, 2.4}});
  plan.right = Signal(Steps(), waves, {{0.40, 0.131, 1.2}});
  return plan;
}

}  // namespace coast::simulate
