#pragma once
// What a first pass through an RTCM file finds that decoding it from its beginning needs. Private to the room.

#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "coast/geo/time.hpp"
#include "coast/record/satellite.hpp"

namespace coast::io {

struct RtcmSurvey {
  std::optional<geo::GpsTime> start;      ///< GPS time at the beginning, to some hours; none: nothing states the week
  bool has_epochs = false;                ///< observations, of any message; without them ephemerides are the clock
  bool week_is_of_file = false;           ///< `start` does not rest on what the caller knew
  std::map<int, int> glonass_channels;    ///< frequency number by slot
  std::set<record::SatelliteSystem> msm;  ///< systems that have observations in MSM4 to MSM7
};

/// Observations state the second of week; the week is that of the file's ephemerides or of 1013, else of `near`.
/// @param near  GPS time to half a week
[[nodiscard]] RtcmSurvey survey_rtcm(const std::filesystem::path& file, std::optional<geo::GpsTime> near);

}  // namespace coast::io
