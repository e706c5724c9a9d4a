#pragma once
// Phase centres of receivers' antennas.

#include <string_view>

#include "coast/carrier/atmosphere.hpp"
#include "coast/record/antenna.hpp"

namespace coast::carrier {

/// By how much a phase (and a code) is longer than from the antenna reference point, m, for an antenna that stands upright and
/// points north: the variation less the offset along the way to the satellite (Rothacher & Schmid 2010, ANTEX 1.4). A band
/// that was not calibrated takes the nearest frequency's of GPS; without any it is zero.
[[nodiscard]] double phase_centre_correction(const record::AntennaCalibration& antenna, record::SatelliteSystem system,
                                             char band, const Direction& direction);

/// The calibration of an antenna by its name in the header of RINEX: with its radome, or else without one (NONE).
/// @return nullptr where there is none
[[nodiscard]] const record::AntennaCalibration* find_antenna(const record::AntennaTable& table, std::string_view name);

}  // namespace coast::carrier
