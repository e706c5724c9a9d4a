#pragma once
// Samples of aiding sensors from tables.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/record/aid.hpp"

namespace coast::io {

/// The keys of an item of `aids:` that describe its file: any table of numbers, as for `gnss:`.
///
///     aids:
///       - kind: odometer
///         file: wheel.csv
///         columns: {time: t, value: v, sd: sv}   # names or numbers, one or three of each
///         gps_week: 2374
///         time: {kind: unix}
struct AidFileOptions {
  std::filesystem::path file;
  std::vector<Column> time_columns;   ///< empty: time_s, or gps_week and sow_s
  std::vector<Column> value_columns;  ///< 1 to 3
  std::vector<Column> sd_columns;     ///< as many, or none
  bool sds_stated = false;            ///< otherwise they are those of the default names, where the header has them
  TimeOptions time;

  /// @param values, sds  default names
  [[nodiscard]] static AidFileOptions from(const config::Node& aid, const std::vector<std::string_view>& values,
                                           const std::vector<std::string_view>& sds);
};

/// Reads the rows. A row with a field that is not a number, or whose time is not after that of the row before, is left out and
/// counted in an event.
/// @param near  an instant of the mission: gives the week if the options do not state one
/// @throws InputError  anything that cannot be read as stated, or no row that can be used; with file and line
[[nodiscard]] record::AidRecording read_aid(const AidFileOptions& options, std::optional<geo::GpsTime> near = std::nullopt);

}  // namespace coast::io
