#pragma once
// One function per file in this folder; they are listed in src/io/trajectory_formats.cpp.

#include "coast/io/writers.hpp"

namespace coast::io {

[[nodiscard]] TrajectoryFormat nav_trajectory();
[[nodiscard]] TrajectoryFormat csv_trajectory();
[[nodiscard]] TrajectoryFormat sbet_trajectory();
[[nodiscard]] TrajectoryFormat pos_trajectory();
[[nodiscard]] TrajectoryFormat kml_trajectory();
[[nodiscard]] TrajectoryFormat gpx_trajectory();
[[nodiscard]] TrajectoryFormat geojson_trajectory();
[[nodiscard]] TrajectoryFormat nmea_trajectory();
[[nodiscard]] TrajectoryFormat tum_trajectory();
[[nodiscard]] TrajectoryFormat kitti_trajectory();
[[nodiscard]] TrajectoryFormat grid_trajectory();
[[nodiscard]] TrajectoryFormat gpkg_trajectory();
[[nodiscard]] TrajectoryFormat gpkg_trajectory();

}  // namespace coast::io
