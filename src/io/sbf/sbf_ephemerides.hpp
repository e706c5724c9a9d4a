#pragma once
// Ephemerides that the receiver has decoded: GPSNav, QZSNav, BDSNav, GALNav, GLONav, GPSIon of SBF. Private to the room.

#include <optional>
#include <string_view>

#include "coast/record/navigation.hpp"

namespace coast::io {

// Each: none for a block that is too short, or of which numbers contradict each other. Whether the orbit is possible, is not
// checked.
/// @param now  GPS time to some hours

/// GPSNav and QZSNav.
[[nodiscard]] std::optional<record::KeplerEphemeris> sbf_gps_ephemeris(std::string_view payload, geo::GpsTime now);
[[nodiscard]] std::optional<record::KeplerEphemeris> sbf_beidou_ephemeris(std::string_view payload, geo::GpsTime now);
[[nodiscard]] std::optional<record::KeplerEphemeris> sbf_galileo_ephemeris(std::string_view payload, geo::GpsTime now);
[[nodiscard]] std::optional<record::TabulatedEphemeris> sbf_glonass_ephemeris(std::string_view payload, geo::GpsTime now);
[[nodiscard]] std::optional<record::Klobuchar> sbf_gps_ionosphere(std::string_view payload);

}  // namespace coast::io
