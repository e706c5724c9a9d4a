#pragma once
// The constant errors of an IMU as a file: what `coast calibrate` finds from rests in many poses, and what `imu: calibration:`
// takes out of a recording.

#include <filesystem>
#include <string>

#include "coast/record/imu_calibration.hpp"

namespace coast::io {

/// @throws InputError  missing or unknown keys, numbers out of range, a covariance that is none; with file and line
[[nodiscard]] record::ImuCalibration read_imu_calibration(const std::filesystem::path& file);

/// The file (schema coast.imu_calibration/1). @param comment  its first lines, each beginning with '#'
[[nodiscard]] std::string imu_calibration_yaml(const record::ImuCalibration& calibration, const std::string& comment);

}  // namespace coast::io
