#pragma once
// What a vehicle does over a stretch of time, in one word.

#include <string_view>

#include "coast/record/trajectory.hpp"

namespace coast::study {

/// In the order of how much of the sensors' errors they bring out.
enum class Manoeuvre { kStatic, kStraight, kAccelerating, kTurn };
[[nodiscard]] std::string_view name(Manoeuvre manoeuvre);

/// By mean horizontal velocities over whole seconds, in this order:
///   static        never faster than 0.2 m/s
///   turn          the course changes by 3 deg/s or more, mean absolute rate of the seconds faster than 0.5 m/s
///   accelerating  speed changes by 0.5 m/s^2 or more, root mean square
///   straight      otherwise
/// A stretch shorter than 3 s is judged with the seconds around it. Where the trajectory has no position the second is left
/// out; straight where none is left.
[[nodiscard]] Manoeuvre manoeuvre_of(const record::Trajectory& trajectory, geo::GpsTime from, geo::GpsTime to);

}  // namespace coast::study
