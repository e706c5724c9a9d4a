#pragma once
// Events of a run, such as exposures of a camera, as files. Each appears complete or not at all (writers.hpp).

#include <filesystem>
#include <vector>

#include "coast/io/projection.hpp"
#include "coast/record/time_mark.hpp"

namespace coast::io {

/// CSV with header, one row each: id, time, position (geodetic and ECEF), velocity, roll, pitch, yaw of the device's axes,
/// standard deviations and correlations as in the CSV of trajectories. 1e-11 deg (1 um), 1e-5 m, 1e-6 m/s, 1e-9 deg, 1 ns.
void write_events_csv(const std::filesystem::path& path, const std::vector<record::MarkedState>& states);

/// CSV with header: id, time, geodetic position, omega, phi, kappa with respect to east-north-up at the event
/// (geo/photogrammetry.hpp), and their standard deviations: N, E, D in m, angles in deg.
/// @param projection  if given, positions are easting, northing, height, and the angles relate to the axes of the grid, which
///                    are turned by the convergence
void write_events_opk(const std::filesystem::path& path, const std::vector<record::MarkedState>& states,
                      const Projection* projection = nullptr);

/// CSV with header: id, time, easting, northing, height, roll, pitch, convergence, heading relative to true and to grid north,
/// standard deviations of the position along the axes of the grid.
void write_events_grid(const std::filesystem::path& path, const std::vector<record::MarkedState>& states,
                       const Projection& projection);

/// CSV that `exiftool -csv=FILE FOLDER` writes into images: SourceFile, position, direction, time (UTC) and accuracy as tags of
/// EXIF. Of events whose name is that of a file, with an extension. The altitude is the height of the projection if that is
/// orthometric, else ellipsoidal less `geoid_height_m`. The direction is that of the view, of a camera that looks down that of
/// the top of its image.
void write_events_exif(const std::filesystem::path& path, const std::vector<record::MarkedState>& states,
                       const Projection* projection, double geoid_height_m);

/// geo.txt of OpenDroneMap in EPSG:4326: image, longitude, latitude, ellipsoidal height, yaw, pitch, roll, horizontal and
/// vertical accuracy (one sigma, m; the larger of north and east). Events that it cannot name are left out.
void write_odm_geo(const std::filesystem::path& path, const std::vector<record::MarkedState>& states);

/// Whether geo.txt can name an event: its columns are separated by blanks.
[[nodiscard]] bool odm_geo_names(const record::TimeMark& mark);

}  // namespace coast::io
