// A sensor on a table: what static records are made of.

#include "motions.hpp"

namespace coast::simulate {

MotionPlan at_rest(const MotionParameters& parameters) {
  Drive drive(parameters);
  drive.cruise(drive.left(0.0)).name_since("rest", 0.0);
  return drive.plan();
}

}  // namespace coast::simulate
