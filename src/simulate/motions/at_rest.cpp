// A sensor on a table, for static records.

#include "motions.hpp"

namespace coast::simulate {

MotionPlan at_rest(const MotionParameters& parameters) {
  Drive drive(parameters);
  const double begin = drive.now();
  drive.cruise(drive.left(0.0)).name_since("rest", begin);
  return drive.plan();
}

}  // namespace coast::simulate
