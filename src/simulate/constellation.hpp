#pragma once
// Broadcast ephemerides of simulated satellites. Private to the room.

#include <vector>

#include "coast/record/navigation.hpp"

namespace coast::simulate {

/// Equally spaced satellites in the planes of the real constellations, with ephemerides for the whole interval: GPS and QZSS
/// every two hours, Galileo every 30 minutes, BeiDou every hour, GLONASS every 30 minutes. Clocks differ by seed.
/// @throws std::invalid_argument  another system
record::NavigationRecording constellation(const std::vector<record::SatelliteSystem>& systems, geo::GpsTime from,
                                          geo::GpsTime to, std::uint64_t seed);

}  // namespace coast::simulate
