#pragma once
// Readers of what a file of NovAtel logs holds. Private to the room; registered by formats/novatel.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] record::ObservationRecording read_novatel_observations(const std::filesystem::path& file);
[[nodiscard]] record::NavigationRecording read_novatel_navigation(const std::filesystem::path& file);
[[nodiscard]] record::TimeMarkRecording read_novatel_time_marks(const std::filesystem::path& file);
[[nodiscard]] record::GnssRecording read_novatel_gnss(const GnssFileOptions& options, Format::Near near);
[[nodiscard]] record::ImuRecording read_novatel_imu(const ImuFileOptions& options, Format::Near near);
[[nodiscard]] record::Trajectory read_novatel_reference(const ReferenceFileOptions& options, Format::Near near);

}  // namespace coast::io
