#pragma once
// Frequencies of satellite signals.

#include <optional>

#include "coast/record/satellite.hpp"

namespace coast::carrier {

inline constexpr double kSpeedOfLight = 299792458.0;  ///< m/s
inline constexpr double kL1Frequency = 1575.42e6;     ///< Hz: reference frequency of ionospheric delays

/// Carrier frequency, Hz, by the band numbers of RINEX 3 (RINEX 3.05, tables 4 to 10); none for a band that the system does not
/// have.
/// @param glonass_channel  -7 to 13; for bands 1 and 2 of GLONASS only
[[nodiscard]] std::optional<double> carrier_frequency(record::SatelliteSystem system, char band, int glonass_channel = 0);
/// Channel number of a GLONASS satellite from its frequency, Hz; 0 for bands with one common frequency.
[[nodiscard]] double glonass_channel(char band, double frequency);

}  // namespace coast::carrier
