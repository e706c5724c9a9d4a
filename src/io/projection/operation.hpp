#pragma once
// Which of the transformations between two CRS is used. Private to the room.

#include <optional>
#include <string>
#include <vector>

#include "coast/geo/earth.hpp"
#include "proj_handles.hpp"

namespace coast::io {

/// One transformation, or several by way of geographic CRS: PROJ does not find every such chain by itself.
struct CoordinateOperation {
  std::vector<ProjObject> steps;          ///< longitude, latitude in degrees, height in m, year to the CRS; empty: none
  std::string name = {};                  ///< in PROJ's words
  std::optional<double> accuracy_m = {};  ///< if it is known
  std::vector<std::string> missing = {};  ///< grids of better transformations that are not installed

  [[nodiscard]] PJ_COORD apply(PJ_COORD coordinates) const;
};

/// The most accurate that can be used at a place. Those that PROJ makes up where it knows none, which leave the datum or the
/// height as it is, are not used.
/// @param datum  geographic CRS of `to`, in three dimensions; null: none
/// @param place  of the positions; absent: anywhere
/// @return       without steps if there is none; `missing` then names the grids that would help
[[nodiscard]] CoordinateOperation best_operation(ProjContext& context, const PJ* from, const PJ* to, const PJ* datum,
                                                 const std::optional<geo::Geodetic>& place);

}  // namespace coast::io
