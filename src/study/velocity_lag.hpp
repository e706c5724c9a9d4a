#pragma once
// Delay of smoothed receiver velocities relative to the receiver's positions.

#include <optional>

#include "coast/record/gnss.hpp"

namespace coast::study {

/// Delay of velocities relative to the positions of the same recording, s; none if there is none, or it is not observable:
/// the lag at which the mean velocity between two fixes is closest to the displacement, if it leaves at most 0.7 of the
/// squared residuals at no lag, and is at least 0.03 s.
[[nodiscard]] std::optional<double> velocity_lag(const record::GnssRecording& gnss);

/// Moves the velocities by `lag_s` to earlier times, by linear interpolation; those at the end without a neighbour are removed.
void advance_velocities(record::GnssRecording& gnss, double lag_s);

}  // namespace coast::study
