#pragma once
// File with the measurements of each member of a synthetic IMU, as written by `coast synth`.

#include <filesystem>
#include <string>
#include <vector>

#include "coast/record/imu.hpp"

namespace coast::io {

/// CSV with the header
///
///     gps_week,from_sow_s,span_s,member,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2
///
/// Rows with the same time form one block; a member without a row is not used in it.
/// @param names  the members in the order of the result
/// @throws InputError  no block, an unknown member, a member twice in a block, blocks that overlap or are out of order; with
///                     line
[[nodiscard]] record::MemberBlocks read_member_blocks(const std::filesystem::path& file, const std::vector<std::string>& names);
void write_member_blocks(const std::filesystem::path& file, const record::MemberBlocks& members);

}  // namespace coast::io
