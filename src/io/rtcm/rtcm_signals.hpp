#pragma once
// Satellites and signals by their numbers in MSM. Private to the room.

#include <cstddef>
#include <optional>

#include "coast/record/satellite.hpp"

namespace coast::io {

/// @param index 1 to 64, the place in the mask of satellites
[[nodiscard]] std::optional<record::Satellite> msm_satellite(record::SatelliteSystem system, std::size_t index);
/// The signal's name in RINEX 3.05.  @param index 1 to 32, the place in the mask of signals
[[nodiscard]] std::optional<record::Signal> msm_signal(record::SatelliteSystem system, std::size_t index);

}  // namespace coast::io
