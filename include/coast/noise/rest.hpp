#pragma once
// Where a recording that should be at rest is moved.

#include <vector>

#include "coast/noise/static_recording.hpp"

namespace coast::noise {

/// What of a recording is at rest.
struct Rest {
  /// s from the begin of the signals that it was told by
  struct Stretch {
    double from = 0.0;
    double to = 0.0;
    [[nodiscard]] double length() const { return to - from; }
  };
  double duration = 0.0;        ///< s, of the recording
  double moved = 0.0;           ///< s in which it is moved
  std::vector<Stretch> places;  ///< at rest for a minute or more, in order
  /// More than a hundredth of the time is no touch of the table.
  [[nodiscard]] bool at_rest() const { return moved <= 0.01 * duration; }
};

/// Means of a second are compared with those before: what a sensor does by itself within a second is its white noise and little
/// beside it, while a hand turns by degrees per second and a vehicle accelerates by decimetres per second squared. A second is
/// moved where an axis changes by more than eight times its own scatter (a quantile of all changes, so that moved seconds do
/// not count) and by more than 0.2 deg/s or 0.05 m/s^2; where the output has coarse steps, also by more than six times what
/// white noise as large as theirs leaves in a mean. Where the scatter itself is far beyond what the samples' white noise leaves
/// in a mean, and beyond 0.5 deg/s or 0.15 m/s^2, the recording is moved throughout. A steady drive without turns looks like
/// rest.
[[nodiscard]] Rest rest_of(const StaticRecording& recording);

}  // namespace coast::noise
