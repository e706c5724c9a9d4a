#pragma once
// Phase centres of receiver antennas.

#include <string_view>

#include "coast/carrier/atmosphere.hpp"
#include "coast/record/antenna.hpp"

namespace coast::carrier {

/// Correction of phase (and code) range relative to the antenna reference point, m, for an upright antenna oriented north: the
/// variation minus the offset along the line of sight (Rothacher & Schmid 2010, ANTEX 1.4). A band without calibration uses
/// that of the nearest GPS frequency; without any it is zero.
[[nodiscard]] double phase_centre_correction(const record::AntennaCalibration& antenna, record::SatelliteSystem system,
                                             char band, const Direction& direction);

/// The calibration of an antenna by its name in the RINEX header: with its radome, or else without one (NONE).
/// @return nullptr if there is none
[[nodiscard]] const record::AntennaCalibration* find_antenna(const record::AntennaTable& table, std::string_view name);

}  // namespace coast::carrier
