#pragma once
// Tables by latitude, common to the troposphere models. Private to the room.

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/geo/units.hpp"

namespace coast::carrier {

/// Values at 15, 30, 45, 60 and 75 degrees, north or south.
using Column = std::array<double, 5>;

/// Linear between the latitudes of the table, constant beyond them. @param latitude  rad
inline double at_latitude(const Column& column, double latitude) {
  const double at = std::clamp(std::abs(latitude) / (15.0 * geo::kDegree) - 1.0, 0.0, 4.0);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(at), 3);
  return std::lerp(column.at(below), column.at(below + 1), at - static_cast<double>(below));
}

}  // namespace coast::carrier
