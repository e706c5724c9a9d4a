#pragma once
// File with the noise density of an IMU over time, as written by `coast synth`.

#include <filesystem>
#include <vector>

#include "coast/record/imu.hpp"

namespace coast::io {

/// CSV with the header
///
///     gps_week,sow_s,gyro_x_radps_rthz,gyro_y_..,gyro_z_..,accel_x_mps2_rthz,accel_y_..,accel_z_..
///
/// A row is valid from its time to that of the next row; the last one for as long as the one before it.
/// @return  densities relative to their means over the time of the file, per axis; the mean itself is given by the error model
/// @throws InputError  fewer than two rows, times that do not increase, densities that are not above zero; with line
[[nodiscard]] std::vector<record::NoiseLevel> read_noise_levels(const std::filesystem::path& file);

}  // namespace coast::io
