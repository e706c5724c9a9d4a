#pragma once
// Uncertainty of the motion while IMU samples are missing.

namespace coast::ins {

/// rad/s: sd of the unknown turn rate. Fits a vehicle in a bend or a drone in a turn; a tumbling body turns faster.
inline constexpr double kGapRateSd = 0.3;

}  // namespace coast::ins
