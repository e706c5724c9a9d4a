#pragma once
// What is not known of the motion while IMU samples are missing.

namespace coast::ins {

/// rad/s: what turns a body meanwhile. A vehicle in a bend, a drone in a turn; a body that is thrown about turns faster.
inline constexpr double kGapRateSd = 0.3;

}  // namespace coast::ins
