#pragma once
// Receivers that smooth their velocities deliver them late against their own positions.

#include <optional>

#include "coast/record/gnss.hpp"

namespace coast::study {

/// By how much velocities lag the positions of the same recording, s; nothing where they do not, or where it cannot be seen:
/// the lag at which the mean velocity between two fixes comes nearest to the displacement, where it leaves at most 0.7 of the
/// squared residuals at no lag, and 0.03 s at least.
[[nodiscard]] std::optional<double> velocity_lag(const record::GnssRecording& gnss);

/// Moves the velocities by `lag_s` towards earlier times, by linear interpolation; those at the end without a neighbour go.
void advance_velocities(record::GnssRecording& gnss, double lag_s);

}  // namespace coast::study
