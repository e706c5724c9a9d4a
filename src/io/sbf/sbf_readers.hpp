#pragma once
// Readers of what an SBF file holds. Private to the room; registered by formats/sbf.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] record::ObservationRecording read_sbf_observations(const std::filesystem::path& file);
[[nodiscard]] record::NavigationRecording read_sbf_navigation(const std::filesystem::path& file);
[[nodiscard]] record::TimeMarkRecording read_sbf_time_marks(const std::filesystem::path& file);
[[nodiscard]] record::GnssRecording read_sbf_gnss(const GnssFileOptions& options, Format::Near near);
[[nodiscard]] record::ImuRecording read_sbf_imu(const ImuFileOptions& options, Format::Near near);

}  // namespace coast::io
