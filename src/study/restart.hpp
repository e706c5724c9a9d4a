#pragma once
// Restart of a mission after a long IMU gap; private to the room.

#include <vector>

#include "coast/study/mission.hpp"

namespace coast::study {

inline constexpr double kLongGap = 1.0;  ///< s without samples; rates and forces at its ends do not determine the motion

/// End of a long gap: the position of the first fix after it, velocity and attitude unknown. Also for a time-reversed
/// recording.
/// @param time_offset_s  a fix tagged t is valid at t - offset
[[nodiscard]] std::vector<estimate::Restart> restarts_at_fixes(const record::ImuRecording& imu,
                                                               const record::GnssRecording& gnss, double time_offset_s,
                                                               const Eigen::Vector3d& lever_arm_b);

/// For each long gap, position, velocity and attitude from the minutes after it, determined like the start of a mission. If the
/// attitude cannot be determined, only the fix is used.
/// @param setup  with the noise, lever arm and time offset in use; data of studied outages must not be used: gaps after
///               `refine_before` have no restart
[[nodiscard]] std::vector<estimate::Restart> restarts_behind_gaps(const record::ImuRecording& imu,
                                                                  const record::GnssRecording& gnss, const Setup& setup);

}  // namespace coast::study
