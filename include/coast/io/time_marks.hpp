#pragma once
// Instants of outside events, such as a camera's shutter: from files of receivers, RINEX and tables.

#include <filesystem>
#include <optional>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/gnss.hpp"
#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/record/time_mark.hpp"

namespace coast::io {

/// The keys of `events:` that describe the file.
///
///     events:
///       file: images.csv                   # or RINEX observations with event records, or UBX with UBX-TIM-TM2, SBF
///       columns: {time: t, id: image, position: [lat, lon, h]}      # id and position are optional
///       frame, utm_zone, origin_deg_m, height, geoid_height_m, gps_week, time: as under `gnss:`
///       edge: any                          # or rising | falling, of UBX and SBF
///
/// Without `columns` a table needs the header time_s, or gps_week and sow_s; the columns id and lat_deg, lon_deg, height_m are
/// read where it has them.
struct TimeMarkFileOptions {
  std::filesystem::path file;
  std::vector<Column> time_columns;      ///< empty: the default names
  Column id_column;                      ///< empty: the default name, or none
  std::vector<Column> position_columns;  ///< three, or empty: the default names, or none
  PositionOptions position;
  TimeOptions time;
  std::optional<record::Edge> edge;  ///< absent: any

  [[nodiscard]] static TimeMarkFileOptions from(const config::Node& events);
  /// A file given by name only, with default options.
  [[nodiscard]] static TimeMarkFileOptions of_file(const std::filesystem::path& file);
};

/// Reads marks in the order of time. Which kind of file it is shows in its content; with `columns` it is a table.
///
/// - UBX: both edges of UBX-TIM-TM2 in GPS time. Marks without valid time, or in the receiver's own time, are counted and left
///   out, with an event.
/// - SBF: edges of ExtEvent in GPS time; those without the bias of the receiver's clock likewise.
/// - NovAtel: MARKTIME, MARK1TIME to MARK4TIME, MARK1PVA to MARK4PVA in GPS time; without valid time as above.
/// - RINEX observations: event records with flag 5, in the time scale of the observations.
/// - Tables: every row; rows whose numbers are empty or not finite are counted and left out, with an event.
///
/// @param near  an instant of the mission: gives the week if neither the file nor the options state one
/// @throws InputError  anything that cannot be read as stated, with file and line; no mark that can be used; an edge of a file
///                     that has none
[[nodiscard]] record::TimeMarkRecording read_time_marks(const TimeMarkFileOptions& options,
                                                        std::optional<geo::GpsTime> near = std::nullopt);

}  // namespace coast::io
