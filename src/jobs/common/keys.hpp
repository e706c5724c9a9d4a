#pragma once
// Values common to the files of several jobs.

#include "coast/config/node.hpp"
#include "coast/geo/earth.hpp"

namespace coast::jobs {

/// [latitude_deg, longitude_deg, height_m]
[[nodiscard]] geo::Geodetic geodetic_from(const config::Node& node);

}  // namespace coast::jobs
