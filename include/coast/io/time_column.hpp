#pragma once
// Meaning of the time column(s) of a table, declared once per file.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/geo/time.hpp"
#include "coast/io/table.hpp"
#include "coast/record/event.hpp"

namespace coast::io {

enum class TimeKind {
  kSecondsOfWeek,   ///< `sow`: GPS seconds of week; the week is stated, or comes from the other file of the mission
  kWeekAndSeconds,  ///< `week_sow`: two columns
  kGpst,            ///< `gpst`: calendar in GPS time, one column ("2025-07-08 19:34:18.5", also with / and T) or two
  kUtc,             ///< `utc`: calendar in UTC, leap seconds applied
  kUnix,            ///< `unix`: POSIX seconds, leap seconds applied
  kElapsed,         ///< `elapsed`: any clock; offset_s is the GPS second of week at its zero
  kRow,             ///< `row`: no time column, rows at rate_hz from offset_s
};

/// The keys under `time:` and `gps_week`.
struct TimeOptions {
  TimeKind kind = TimeKind::kSecondsOfWeek;
  bool kind_given = false;
  double unit_s = 1.0;    ///< s per unit of the column (unit: s | ms | us | ns)
  double offset_s = 0.0;  ///< added after the unit
  double rate_hz = 0.0;   ///< kRow only
  std::optional<int> gps_week;
  std::string file_key;  ///< key that names the file, for messages

  /// @param map the node that holds `time:` and `gps_week:` (imu, gnss or reference)
  [[nodiscard]] static TimeOptions from(const config::Node& map);
  /// True for seconds of week without a week.
  [[nodiscard]] bool lacks_week() const;
};

/// Converts seconds of week to GpsTime: the week is stated, or the nearest to `near`; a decrease by about one week is a
/// rollover, unwrapped with an event.
class WeekClock {
 public:
  /// Makes the error for the current row from found, expected, what to do.
  using MakeError = std::function<InputError(std::string, std::string, std::string)>;
  WeekClock(const TimeOptions& options, std::optional<geo::GpsTime> near, MakeError error);

  /// @throws InputError  no week is given; not a time
  [[nodiscard]] geo::GpsTime at(double seconds);
  [[nodiscard]] const record::Events& events() const { return events_; }

 private:
  std::optional<int> week_;
  std::optional<geo::GpsTime> near_;
  bool unwrap_;
  MakeError error_;
  double last_seconds_ = 0.0;
  bool started_ = false;
  record::Events events_;
};

/// Converts the time column(s) of a row to GpsTime. A decrease by about one week is a rollover, unwrapped with an event.
class TimeColumn {
 public:
  /// @param columns one or two columns, none for kRow
  /// @param near an instant of the same mission, from the other file: gives the week if none is stated
  /// @throws InputError  no week is given; a column does not exist; the number of columns does not fit the kind
  TimeColumn(TableReader& table, const TimeOptions& options, const std::vector<Column>& columns,
             std::optional<geo::GpsTime> near);

  /// @throws InputError  not a time; with the line
  [[nodiscard]] geo::GpsTime read();
  [[nodiscard]] const record::Events& events() const { return clock_.events(); }

 private:
  [[nodiscard]] geo::GpsTime from_text();

  TableReader& table_;
  TimeOptions options_;
  WeekClock clock_;
  std::size_t slot_ = 0;
  std::size_t slot2_ = 0;
  bool two_columns_ = false;
};

/// The default time columns where none are given: time_s, or gps_week and sow_s as in coast's own trajectories.
void default_time_columns(const TableReader& table, TimeOptions& time, std::vector<Column>& columns);

/// GPS week for which `seconds_of_week` is nearest to `near`.
[[nodiscard]] int nearest_week(double seconds_of_week, geo::GpsTime near);

}  // namespace coast::io
