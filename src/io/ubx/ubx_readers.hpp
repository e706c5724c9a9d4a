#pragma once
// Readers of what a UBX file holds. Private to the room; registered by formats/ubx.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] record::ObservationRecording read_ubx_observations(const std::filesystem::path& file);
[[nodiscard]] record::NavigationRecording read_ubx_navigation(const std::filesystem::path& file);
[[nodiscard]] record::TimeMarkRecording read_ubx_time_marks(const std::filesystem::path& file);
[[nodiscard]] record::GnssRecording read_ubx_gnss(const GnssFileOptions& options, Format::Near near);
[[nodiscard]] record::ImuRecording read_ubx_imu(const ImuFileOptions& options, Format::Near near);

}  // namespace coast::io
