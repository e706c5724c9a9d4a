#pragma once
// From raw rows to increments: steps after parsing common to all IMU formats.

#include <string>

#include "coast/io/imu.hpp"
#include "coast/record/imu.hpp"

namespace coast::io {

/// Rejects values impossible for any IMU: beyond 1e6 rad/s or m/s^2 (as increments: rad or m/s).
/// @param error makes the error of the current row
void require_possible(const record::ImuSample& row, const WeekClock::MakeError& error);

/// Converts rows (tag in t, rates or increments in dtheta and dv, SI) to contiguous increments, in place; sets the rate and
/// lists the gaps.
/// @throws InputError  fewer than two rows
void finish_imu(record::ImuRecording& recording, bool increments, TimeTag tag);

}  // namespace coast::io
