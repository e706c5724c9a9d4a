#pragma once
// Behind a long gap of the IMU a mission begins anew; private to the room.

#include <vector>

#include "coast/study/mission.hpp"

namespace coast::study {

inline constexpr double kLongGap = 1.0;  ///< s without samples, over which rates and forces at its ends tell nothing

/// Where a long gap ends: the position of the first fix behind it, and nothing of velocity and attitude. For a recording run
/// backwards, too.
/// @param time_offset_s  a fix tagged t is valid at t - offset
[[nodiscard]] std::vector<estimate::Restart> restarts_at_fixes(const record::ImuRecording& imu,
                                                               const record::GnssRecording& gnss, double time_offset_s,
                                                               const Eigen::Vector3d& lever_arm_b);

/// For each long gap what the minutes behind it tell of position, velocity and attitude, found as the start of a mission is.
/// Where they do not show the attitude it is the fix alone.
/// @param setup  with the noise, lever arm and time offset that are in use; no outage that is studied may be looked into:
///               gaps behind `refine_before` have no restart
[[nodiscard]] std::vector<estimate::Restart> restarts_behind_gaps(const record::ImuRecording& imu,
                                                                  const record::GnssRecording& gnss, const Setup& setup);

}  // namespace coast::study
