#pragma once
// The CRS that positions are written in, checked. Private to the room.

#include "coast/io/projection.hpp"
#include "proj_handles.hpp"

namespace coast::io {

/// One coordinate of a CRS.
struct GridAxis {
  int index = 0;            ///< among the coordinates that PROJ gives
  double direction = 1.0;   ///< -1: to the west or to the south
  double metres = 1.0;      ///< per unit
  std::string column = {};  ///< easting_m
};

struct TargetCrs {
  ProjObject crs;         ///< with a third axis in any case
  ProjObject horizontal;  ///< its projected part alone
  std::string stated;     ///< as a user can write it
  std::string name;
  std::string heights;
  bool orthometric = false;
  GridAxis easting, northing, height;
};

/// @throws InputError  unknown, not projected, or contradicting `orthometric`
[[nodiscard]] TargetCrs target_crs(ProjContext& context, const ProjectionOptions& options);
/// The geographic CRS of the positions, with heights.  @throws InputError  unknown, not geographic, not in degrees
[[nodiscard]] ProjObject source_crs(ProjContext& context, const std::string& from);

}  // namespace coast::io
