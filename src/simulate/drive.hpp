#pragma once
// A script of manoeuvres, one after the other, converted to the speed, course and slope of a motion plan.

#include <string>
#include <vector>

#include "coast/simulate/motions.hpp"

namespace coast::simulate {

/// Each call advances the clock by the manoeuvre's nominal duration. Angles in degrees, for readable scripts.
class Drive {
 public:
  explicit Drive(const MotionParameters& parameters);

  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] double speed() const { return speed_now_; }

  Drive& cruise(double seconds);
  /// Changes the speed to `mps`, with most of the change within `seconds`.
  Drive& speed_to(double mps, double seconds);
  /// Changes the course; positive to the right. After a start from rest it waits until the body moves.
  Drive& turn(double degrees, double seconds);
  /// The same with a constant turn rate between entry and exit of about two seconds each: a circle at constant speed.
  Drive& circle(double degrees, double seconds);
  /// Changes the slope of the path to `degrees`, positive up. Does not advance the clock: it is simultaneous with the
  /// following manoeuvres. Call it once the body moves.
  Drive& slope_to(double degrees, double seconds);
  /// Completes turns and slopes, brakes to rest and waits: exactly at rest for at least `seconds`.
  Drive& stop(double braking_seconds, double seconds);
  /// Names the stretch from `start` until now.
  Drive& name_since(const std::string& name, double start);
  /// Remaining time until `seconds` before the end of the mission; negative when past it.
  [[nodiscard]] double left(double seconds) const { return parameters_.duration - seconds - now_; }

  /// Speed, course, slope and named stretches; the rest of the plan is to be set by the caller.
  [[nodiscard]] MotionPlan plan() const;
  [[nodiscard]] const std::vector<Step>& course_steps() const { return course_; }
  /// The speed over time as an envelope that is 1 at `reference` m/s and 0 at rest.
  [[nodiscard]] Steps envelope(double reference) const;

 private:
  MotionParameters parameters_;
  double now_;
  double speed_now_ = 0.0;
  double slope_now_ = 0.0;
  double moving_from_ = 0.0;  // nominal start of the last start from rest
  double settled_ = 0.0;      // time when the last turn and slope are exactly completed
  std::vector<Step> speed_, course_, slope_;
  std::vector<Manoeuvre> manoeuvres_;
};

/// Starts, brakes and turns both ways for about 85 s, as usual to align an IMU; ends at `cruise_mps`.
void alignment_drive(Drive& drive, double cruise_mps);

}  // namespace coast::simulate
