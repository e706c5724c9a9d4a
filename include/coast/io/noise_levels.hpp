#pragma once
// A file of how noisy an IMU was over time, as `coast synth` writes it.

#include <filesystem>
#include <vector>

#include "coast/record/imu.hpp"

namespace coast::io {

/// CSV with the header
///
///     gps_week,sow_s,gyro_x_radps_rthz,gyro_y_..,gyro_z_..,accel_x_mps2_rthz,accel_y_..,accel_z_..
///
/// A row holds from its time to the next one's; the last as long as the one before.
/// @return  densities relative to their means over the file's time, axis by axis: the error model says how large the mean is
/// @throws InputError  fewer than two rows, times that do not increase, densities that are not above zero; with line
[[nodiscard]] std::vector<record::NoiseLevel> read_noise_levels(const std::filesystem::path& file);

}  // namespace coast::io
