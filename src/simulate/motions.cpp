#include "coast/simulate/motions.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "motions/motions.hpp"

namespace coast::simulate {

const std::vector<MotionKind>& motions() {
  static const std::vector<MotionKind> kTable = {
      {"car_roundabout", "city car; one and a half turns of a roundabout of 15 m radius", 300.0, car_roundabout},
      {"car_straight", "car on a straight road, acceleration strongly varying between 5 and 30 m/s", 300.0, car_straight},
      {"city", "car in streets with stops, right angles and U-turns", 200.0, city},
      {"survey_drone", "multicopter flying parallel lines at 60 m, in wind", 240.0, survey_drone},
      {"aircraft_lines", "aircraft flying lines at 60 m/s joined by turns with 45 degrees of bank", 480.0, aircraft_lines},
      {"boat", "survey boat in swell and chop", 200.0, boat},
      {"ski", "skier with swings at 2 to 3 Hz and 35 degrees of roll", 200.0, ski},
      {"at_rest", "nothing moves: a static record, for calibration", 10.0, at_rest},
      {"pedestrian", "walker with the IMU on the body, moving at 5 to 10 Hz", 100.0, pedestrian},
  };
  return kTable;
}

AnalyticTrajectory make_motion(std::string_view kind, const MotionParameters& parameters) {
  constexpr double kLongest = 1e5;
  if (!(parameters.static_start >= 0.0))
    throw std::invalid_argument(fmt::format("static start is {} s, expected at least 0", parameters.static_start));
  for (const MotionKind& motion : motions()) {
    if (motion.name != kind) continue;
    const double shortest = motion.shortest + parameters.static_start;
    if (!(parameters.duration >= shortest && parameters.duration <= kLongest))
      throw std::invalid_argument(
          fmt::format("duration is {} s, expected {} to {} s for {}", parameters.duration, shortest, kLongest, kind));
    return AnalyticTrajectory(motion.make(parameters));
  }
  throw std::invalid_argument(fmt::format("unknown motion '{}'", kind));
}

}  // namespace coast::simulate
