#pragma once
// A script of manoeuvres, one after the other, that becomes the speed, course and slope of a motion plan.

#include <string>
#include <vector>

#include "coast/simulate/motions.hpp"

namespace coast::simulate {

/// Each call advances the clock by the manoeuvre's nominal duration. Angles in degrees: scripts are for people.
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
  /// Changes the slope of the path to `degrees`, positive up. Takes no time of its own: it accompanies
  /// what follows. Call it once the body moves.
  Drive& slope_to(double degrees, double seconds);
  /// Lets turns and slopes come to their end, brakes to rest and waits: exactly at rest for at least `seconds`.
  Drive& stop(double braking_seconds, double seconds);
  /// Names the stretch from `start` until now.
  Drive& name_since(const std::string& name, double start);
  /// Remaining time until `seconds` before the end of the mission; negative when past it.
  [[nodiscard]] double left(double seconds) const { return parameters_.duration - seconds - now_; }

  /// Speed, course, slope and named stretches; the rest of the plan is for the caller to fill in.
  [[nodiscard]] MotionPlan plan() const;
  [[nodiscard]] const std::vector<Step>& course_steps() const { return course_; }
  /// The speed's course in time as an envelope that is 1 at `reference` m/s and 0 at rest.
  [[nodiscard]] Steps envelope(double reference) const;

 private:
  MotionParameters parameters_;
  double now_;
  double speed_now_ = 0.0;
  double slope_now_ = 0.0;
  double moving_from_ = 0.0;  // nominal start of the last start from rest
  double settled_ = 0.0;      // when the last turn and slope are exactly over
  std::vector<Step> speed_, course_, slope_;
  std::vector<Manoeuvre> manoeuvres_;
};

/// Starts, brakes and turns both ways for about 85 s, as one drives to align an IMU; ends at `cruise_mps`.
void alignment_drive(Drive& drive, double cruise_mps);

}  // namespace coast::simulate
