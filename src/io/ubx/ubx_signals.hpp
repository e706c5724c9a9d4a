#pragma once
// Satellites and signals by u-blox's numbers. Private to the room.

#include <cstdint>
#include <optional>

#include "coast/record/satellite.hpp"

namespace coast::io {

/// @param gnss gnssId  @param sv svId; 255 of GLONASS: not yet known
[[nodiscard]] std::optional<record::Satellite> ubx_satellite(std::uint8_t gnss, std::uint8_t sv);
/// The signal's name in RINEX 3.05.
[[nodiscard]] std::optional<record::Signal> ubx_signal(record::SatelliteSystem system, std::uint8_t signal);

}  // namespace coast::io
