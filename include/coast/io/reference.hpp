#pragma once
// Trajectories from files: references, and the two sides of a comparison.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::io {

/// Meaning of the attitude columns of a table: z-y-x Euler angles in degrees, or a Hamilton quaternion.
struct AttitudeOptions {
  enum class Form { kNone, kEuler, kQuaternion };
  Form form = Form::kNone;
  bool to_enu = false;    ///< the attitude transforms body to east-north-up, else to north-east-down
  bool body_flu = false;  ///< the body axes are forward-left-up, else forward-right-down
};

/// The keys of `reference:` that describe the file.
///
///     reference:
///       file: truth.nav
///       format: auto                       # or nav | csv (any delimiter) | sbet | novatel
///       columns: {time: 1, position: [2, 3, 4], velocity: [..], euler: [roll, pitch, yaw]}       # or quaternion: [x, y, z, w]
///       attitude_to: ned                   # or enu
///       body_axes: frd                     # or flu
///       frame, utm_zone, origin_deg_m, height, geoid_height_m, gps_week, time, topic: as under `gnss:`
///
/// SBET times are GPS seconds of week (some programs write UTC seconds of week: `time: {offset_s: 18}`).
struct ReferenceFileOptions {
  std::filesystem::path file;
  std::shared_ptr<const record::Table> table = {};  ///< in place of the file, with the columns of a CSV file
  std::string format = "auto";
  std::vector<Column> time_columns;
  std::vector<Column> position_columns;
  std::vector<Column> velocity_columns;  ///< N, E, D; empty: none
  std::vector<Column> attitude_columns;  ///< three angles, or a quaternion x, y, z, w
  AttitudeOptions attitude;
  PositionOptions position;
  TimeOptions time;
  std::string topic;  ///< of a bag; empty: the only one with poses

  [[nodiscard]] static ReferenceFileOptions from(const config::Node& reference);
  /// A file given by name only (the command line of `coast compare`), with default options.
  [[nodiscard]] static ReferenceFileOptions of_file(const std::filesystem::path& file);
};

/// Reads a trajectory.  @param near an instant of the mission: gives the week if neither file (week 0) nor options state one
/// @throws InputError  anything that cannot be read as stated; with file and line
[[nodiscard]] record::Trajectory read_reference(const ReferenceFileOptions& options,
                                                std::optional<geo::GpsTime> near = std::nullopt);

}  // namespace coast::io
