#include "drive.hpp"

#include <algorithm>
#include <cmath>

#include "coast/geo/units.hpp"

namespace coast::simulate {

using geo::kDegree;

Drive::Drive(const MotionParameters& parameters) : parameters_(parameters), now_(parameters.static_start) {}

Drive& Drive::cruise(double seconds) {
  now_ += seconds;
  return *this;
}

Drive& Drive::speed_to(double mps, double seconds) {
  if (speed_now_ == 0.0) {
    // The beginning of the step is delayed, so that the time at rest is exact.
    now_ += Steps::reach(seconds);
    moving_from_ = now_;
  }
  speed_.push_back({now_, seconds, mps - speed_now_});
  speed_now_ = mps;
  return cruise(seconds);
}

Drive& Drive::turn(double degrees, double seconds) {
  now_ = std::max(now_, moving_from_ + Steps::reach(seconds));
  course_.push_back({now_, seconds, degrees * kDegree});
  settled_ = std::max(settled_, now_ + seconds + Steps::reach(seconds));
  return cruise(seconds);
}

Drive& Drive::circle(double degrees, double seconds) {
  // Steps of sigma, spaced by sigma: their sum's slope is constant to exp(-2 pi^2) = 3e-9.
  constexpr double kSigma = 1.0;
  const auto count = std::max(1, static_cast<int>(std::lround(seconds / kSigma)));
  const double spacing = seconds / count;
  settled_ = std::max(settled_, now_ + seconds + 3.0 * spacing + Steps::reach(6.0 * spacing));
  for (int i = 0; i < count; ++i)
    course_.push_back({now_ + (i + 0.5) * spacing - 3.0 * spacing, 6.0 * spacing, degrees * kDegree / count});
  return cruise(seconds);
}

Drive& Drive::slope_to(double degrees, double seconds) {
  const double start = std::max(now_, moving_from_ + Steps::reach(seconds));
  slope_.push_back({start, seconds, degrees * kDegree - slope_now_});
  settled_ = std::max(settled_, start + seconds + Steps::reach(seconds));
  slope_now_ = degrees * kDegree;
  return *this;
}

Drive& Drive::stop(double braking_seconds, double seconds) {
  now_ = std::max(now_, settled_ - braking_seconds);
  speed_to(0.0, braking_seconds);
  return cruise(Steps::reach(braking_seconds) + seconds);
}

Drive& Drive::name_since(const std::string& name, double start) {
  manoeuvres_.push_back({name, start, now_ - start});
  return *this;
}

MotionPlan Drive::plan() const {
  MotionPlan plan;
  plan.origin = parameters_.origin;
  plan.duration = parameters_.duration;
  plan.speed = Steps(0.0, speed_);
  plan.course = Steps(parameters_.course, course_);
  plan.slope = Steps(0.0, slope_);
  plan.manoeuvres = manoeuvres_;
  return plan;
}

Steps Drive::envelope(double reference) const {
  std::vector<Step> scaled = speed_;
  for (Step& step : scaled) step.change /= reference;
  return Steps(0.0, scaled);
}

void alignment_drive(Drive& drive, double cruise_mps) {
  const double turning_mps = 0.55 * cruise_mps;
  drive.speed_to(cruise_mps, 8.0).cruise(3.0).speed_to(turning_mps, 5.0).turn(85.0, 6.0).turn(-95.0, 6.0);
  drive.speed_to(cruise_mps, 5.0).cruise(2.0).speed_to(turning_mps, 4.0).turn(-80.0, 5.0).cruise(4.0);
  drive.turn(90.0, 6.0).stop(5.0, 3.0).speed_to(cruise_mps, 7.0).cruise(3.0);
}

}  // namespace coast::simulate
