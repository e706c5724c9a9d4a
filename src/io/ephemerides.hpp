#pragma once
// Checks and order of broadcast ephemerides, whatever they were read from. Private to the room.

#include "coast/record/navigation.hpp"

namespace coast::io {

/// An orbit of a navigation satellite: above the ground, below 64 000 km, eccentricity below 0.5, all elements finite.
[[nodiscard]] bool is_possible(const record::KeplerEphemeris& ephemeris);
[[nodiscard]] bool is_possible(const record::TabulatedEphemeris& ephemeris);

/// The instant with this second of week that is nearest to another.
[[nodiscard]] geo::GpsTime nearest_second_of_week(geo::GpsTime to, double sow);

/// By satellite and time; of repeated ephemerides the first is kept.  @return number of repeated ones
[[nodiscard]] long sort_out(record::NavigationRecording& recording);

}  // namespace coast::io
