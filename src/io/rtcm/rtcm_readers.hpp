#pragma once
// Readers of what an RTCM 3 file holds. Private to the room; registered by formats/rtcm3.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

/// @param near  GPS time to half a week, for a file in which nothing states the week
[[nodiscard]] record::ObservationRecording read_rtcm_observations(const std::filesystem::path& file,
                                                                  std::optional<geo::GpsTime> near);
[[nodiscard]] record::NavigationRecording read_rtcm_navigation(const std::filesystem::path& file,
                                                               std::optional<geo::GpsTime> near);

}  // namespace coast::io
