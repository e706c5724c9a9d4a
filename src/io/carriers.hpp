#pragma once
// Carrier frequencies, for protocols that state phases in metres or milliseconds. Private to the room.

#include <optional>

#include "coast/record/satellite.hpp"

namespace coast::io {

/// Carrier of a RINEX 3.05 band, Hz (RINEX 3.05, tables 9 to 16); none for a band that the system does not have.
/// @param channel frequency number of GLONASS; without it its bands 1 and 2 have none
[[nodiscard]] std::optional<double> carrier_frequency(record::SatelliteSystem system, char band,
                                                      std::optional<int> channel = {});

inline constexpr double kSpeedOfLight = 299'792'458.0;  ///< m/s

}  // namespace coast::io
