#pragma once
// GNSS positions from files.

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/geo/earth.hpp"
#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/record/gnss.hpp"

namespace coast::io {

/// Meaning of the three position columns of a table.
struct PositionOptions {
  enum class Frame { kGeodetic, kEcef, kUtm, kNed, kEnu };
  Frame frame = Frame::kGeodetic;  ///< kGeodetic: latitude, longitude [deg], height [m]; kUtm: easting, northing, height
  int utm_zone = 0;
  bool utm_north = true;
  std::optional<geo::Geodetic> origin;  ///< of kNed and kEnu
  bool above_mean_sea_level = false;
  std::optional<double> geoid_height;  ///< m, geoid above ellipsoid

  /// Keys `frame`, `utm_zone: 18N`, `origin_deg_m: [lat, lon, h]`, `height: ellipsoidal | msl`, `geoid_height_m`.
  [[nodiscard]] static PositionOptions from(const config::Node& map);
};

/// The keys of `gnss:` that describe the file.
///
///     gnss:
///       file: gnss.pos
///       format: auto                       # or rtklib-pos | kf-gins | csv (any delimiter), or a receiver's own
///       columns: {time: t, position: [lat, lon, h], sd: [5, 6, 7], velocity: [vn, ve, vd], velocity_sd: [..],
///                 quality: Q, satellites: ns}
///       frame: geodetic                    # or ecef | utm | ned | enu
///       utm_zone: 18N
///       origin_deg_m: [32.8, 35.0, 200.0]  # of ned and enu
///       sd_m: [0.02, 0.02, 0.04]           # N, E, D, if the file has none, or none that can be used
///       velocity_sd_mps: [0.05, 0.05, 0.1]
///       height: ellipsoidal                # or msl, with geoid_height_m
///       gps_week: 2374
///       time: {kind: unix}
///       topic: /fix                        # of a bag with several
///
/// Velocities are N, E, D; standard deviations N, E, D. Without `columns` a CSV file needs the header
/// time_s, lat_deg, lon_deg, height_m, sdn_m, sde_m, sdd_m [, vn_mps, ve_mps, vd_mps, sdvn_mps, sdve_mps, sdvd_mps].
struct GnssFileOptions {
  std::filesystem::path file;
  std::shared_ptr<const record::Table> table = {};  ///< in place of the file, with the columns of a CSV file
  std::string format = "auto";
  std::vector<Column> time_columns;         ///< empty: the default name
  std::vector<Column> position_columns;     ///< three, or empty: the default names
  std::vector<Column> sd_columns;           ///< three, or empty: `sd`, or the default names where the header has them
  std::vector<Column> velocity_columns;     ///< three, or empty
  std::vector<Column> velocity_sd_columns;  ///< three, or empty: `velocity_sd`
  Column quality_column;                    ///< RTKLIB's numbers
  Column satellites_column;
  PositionOptions position;
  std::optional<Eigen::Vector3d> sd;           ///< N, E, D, m; replaces the standard deviations in the file
  std::optional<Eigen::Vector3d> velocity_sd;  ///< N, E, D, m/s
  TimeOptions time;
  std::string topic;  ///< of a bag; empty: the only one with positions

  [[nodiscard]] static GnssFileOptions from(const config::Node& gnss);
};

/// Reads GNSS fixes. A standard deviation that is zero, negative or absent is an error that names the line: a fix without
/// uncertainty has no weight. Correlations beyond 1 by rounding in the file are reduced, with an event; larger ones are an
/// error. Heights above mean sea level without `geoid_height_m` are not converted; a warning is given.
/// @param near an instant of the mission: gives the week if neither the file nor the options state one
/// @throws InputError  anything that cannot be read as stated; with file and line
[[nodiscard]] record::GnssRecording read_gnss(const GnssFileOptions& options, std::optional<geo::GpsTime> near = std::nullopt);

}  // namespace coast::io
