#pragma once
// From raw rows to increments: what every IMU format does after parsing.

#include <string>

#include "coast/io/imu.hpp"
#include "coast/record/imu.hpp"

namespace coast::io {

/// Refuses what no IMU can read: beyond 1e6 rad/s or m/s^2 (as increments: rad or m/s).
/// @param error makes the error of the current row
void require_possible(const record::ImuSample& row, const WeekClock::MakeError& error);

/// Turns rows (tag in t, rates or increments in dtheta and dv, SI) into increments that tile time, in place; finds the rate and
/// lists the gaps.
/// @throws InputError  fewer than two rows
void finish_imu(record::ImuRecording& recording, bool increments, TimeTag tag);

}  // namespace coast::io
