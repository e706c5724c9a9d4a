#pragma once
// Classifies the motion of a vehicle over a period.

#include <string_view>

#include "coast/record/trajectory.hpp"

namespace coast::study {

/// In increasing order of their effect on sensor errors.
enum class Manoeuvre { kStatic, kStraight, kAccelerating, kTurn };
[[nodiscard]] std::string_view name(Manoeuvre manoeuvre);

/// By mean horizontal velocities over whole seconds, in this order:
///   static        never faster than 0.2 m/s
///   turn          the course changes by 3 deg/s or more, mean absolute rate of the seconds faster than 0.5 m/s
///   accelerating  speed changes by 0.5 m/s^2 or more, root mean square
///   straight      otherwise
/// A period shorter than 3 s is classified with the seconds around it. Seconds without a position are left out; straight if
/// none is left.
[[nodiscard]] Manoeuvre manoeuvre_of(const record::Trajectory& trajectory, geo::GpsTime from, geo::GpsTime to);

}  // namespace coast::study
