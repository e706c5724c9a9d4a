#pragma once
// Finds motion in a recording that should be at rest.

#include <vector>

#include "coast/noise/static_recording.hpp"

namespace coast::noise {

/// Parts of a recording that are at rest.
struct Rest {
  /// s from the start of the signals used
  struct Stretch {
    double from = 0.0;
    double to = 0.0;
    [[nodiscard]] double length() const { return to - from; }
  };
  double duration = 0.0;        ///< s, of the recording
  double moved = 0.0;           ///< s with motion
  std::vector<Stretch> places;  ///< at rest for a minute or more, in order
  /// Up to a hundredth of the time may be disturbed, e.g. by touching the table.
  [[nodiscard]] bool at_rest() const { return moved <= 0.01 * duration; }
};

/// One-second means are compared with the previous ones: within a second the sensor error changes by little more than its white
/// noise, while a hand turns by degrees per second and a vehicle accelerates by decimetres per second squared. A second has
/// motion if an axis changes by more than eight times its own scatter (a quantile of all changes, so that seconds with motion
/// do not count) and by more than 0.2 deg/s or 0.05 m/s^2; for coarsely quantised output, also by more than six times the noise
/// in a mean of white noise as large as the quantisation. If the scatter itself is far above that expected from the samples'
/// white noise, and above 0.5 deg/s or 0.15 m/s^2, the whole recording is in motion. Steady driving without turns cannot be
/// distinguished from rest.
[[nodiscard]] Rest rest_of(const StaticRecording& recording);

}  // namespace coast::noise
