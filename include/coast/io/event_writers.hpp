#pragma once
// Events of a run, such as exposures of a camera, as files. Each appears complete or not at all (writers.hpp).

#include <filesystem>
#include <vector>

#include "coast/record/time_mark.hpp"

namespace coast::io {

/// CSV with header, one row each: id, time, position (geodetic and ECEF), velocity, roll, pitch, yaw of the device's axes,
/// standard deviations and correlations as in the CSV of trajectories. 1e-11 deg (1 um), 1e-5 m, 1e-6 m/s, 1e-9 deg, 1 ns.
void write_events_csv(const std::filesystem::path& path, const std::vector<record::MarkedState>& states);

/// CSV with header: id, time, geodetic position, omega, phi, kappa with respect to east-north-up at the event
/// (geo/photogrammetry.hpp), and their standard deviations: N, E, D in m, angles in deg.
void write_events_opk(const std::filesystem::path& path, const std::vector<record::MarkedState>& states);

/// geo.txt of OpenDroneMap in EPSG:4326: image, longitude, latitude, ellipsoidal height, yaw, pitch, roll, horizontal and
/// vertical accuracy (one sigma, m; the larger of north and east). Events that it cannot name are left out.
void write_odm_geo(const std::filesystem::path& path, const std::vector<record::MarkedState>& states);

/// Whether geo.txt can name an event: its columns are separated by blanks.
[[nodiscard]] bool odm_geo_names(const record::TimeMark& mark);

}  // namespace coast::io
