#pragma once
// Readers of the binary output of VectorNav sensors. Private to the room; registered by formats/vectornav.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

/// A whole message is in the first bytes of a file, or a head of records with one.
[[nodiscard]] bool begins_as_vectornav(std::string_view head);
[[nodiscard]] record::ImuRecording read_vectornav_imu(const ImuFileOptions& options, Format::Near near);
[[nodiscard]] record::GnssRecording read_vectornav_gnss(const GnssFileOptions& options, Format::Near near);
[[nodiscard]] record::ObservationRecording read_vectornav_observations(const std::filesystem::path& file);

}  // namespace coast::io
