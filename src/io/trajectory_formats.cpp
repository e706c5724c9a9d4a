#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "coast/io/writers.hpp"
#include "writers/writers.hpp"

namespace coast::io {

const std::vector<TrajectoryFormat>& trajectory_formats() {
  static const std::vector<TrajectoryFormat> table = {
      nav_trajectory(),     csv_trajectory(),  sbet_trajectory(), pos_trajectory(),   kml_trajectory(),  gpx_trajectory(),
      geojson_trajectory(), nmea_trajectory(), tum_trajectory(),  kitti_trajectory(), grid_trajectory(), gpkg_trajectory(),
  };
  return table;
}

const TrajectoryFormat& trajectory_format(std::string_view name) {
  const auto format = std::ranges::find(trajectory_formats(), name, &TrajectoryFormat::name);
  if (format == trajectory_formats().end()) throw std::invalid_argument(fmt::format("name: no trajectory format \"{}\"", name));
  return *format;
}

std::string file_of(std::string_view stem, const TrajectoryFormat& format) {
  return fmt::format("{}.{}", stem, format.extension.empty() ? format.name : format.extension);
}

std::filesystem::path companion_of(const std::filesystem::path& file, std::string_view companion) {
  std::filesystem::path beside = file;
  return beside.replace_extension(companion);
}

}  // namespace coast::io
