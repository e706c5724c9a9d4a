#pragma once
// IMU recordings from files, in the axes of the sensor.

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/record/imu.hpp"

namespace coast::io {

enum class TimeTag { kEnd, kCentre, kStart };

/// Layout of raw binary records (`format: binary`).
struct BinaryLayout {
  enum class Type { kI16, kI32, kF32, kF64 };
  Type type = Type::kI16;
  int row = 0;            ///< numbers per record; 0: the highest column in use
  long header_bytes = 0;  ///< skipped at the start
  bool big_endian = false;
};

/// The keys of `imu:` that describe the file.
///
///     imu:
///       file: imu.csv.gz
///       format: auto                       # or csv (any delimiter) | kf-gins | imr | binary, or a receiver's own
///       gps_week: 2374
///       columns: {time: tow_s, gyro: [5, 6, 7], accel: [fx, fy, fz], temperature: T}     # names, or numbers from 1
///       units: {gyro: deg/s, accel: g}     # of rates; with `values: increments`: rad | deg, m/s
///       scale: {gyro: 0.05, accel: 0.00333}                                              # counts to the unit
///       values: rates                      # or increments
///       time: {kind: sow, unit: ms, offset_s: 243000.0}
///       time_tag: end                      # or centre | start
///       binary: {type: i16, row: 6}
///       topic: /imu/data                   # of a bag with several
///
/// Without `columns` a CSV file needs the default header: time_s, gyro_x_radps, .., accel_x_mps2, .., [temperature_degC].
struct ImuFileOptions {
  std::filesystem::path file;
  std::shared_ptr<const record::Table> table = {};  ///< in place of the file, with the columns of a CSV file
  std::string format = "auto";
  std::vector<Column> time_columns;  ///< empty: the default name
  std::vector<Column> gyro_columns;  ///< three, or empty: the default names
  std::vector<Column> accel_columns;
  Column temperature_column;  ///< empty: none, or the default name if the header has it
  double gyro_to_si = 1.0;    ///< to rad/s (rates) or rad (increments), scale included
  double accel_to_si = 1.0;   ///< to m/s^2 or m/s
  bool increments = false;
  TimeOptions time;
  TimeTag time_tag = TimeTag::kEnd;
  BinaryLayout binary;
  std::string topic;  ///< of a bag; empty: the only one with an IMU

  [[nodiscard]] static ImuFileOptions from(const config::Node& imu);
};

/// Reads an IMU file into increments. Intervals are contiguous: each begins where the previous one ends. Rates are means over
/// the interval that ends at the tag; over missing samples (a step of more than 1.5 median intervals) the rate is interpolated
/// linearly, with an `imu_gap` event. Rows with NaN are left out (which makes a gap), as are leading rows of exact zeros.
/// @param near an instant of the mission: gives the week if neither the file nor the options state one
/// @throws InputError  anything that cannot be read as stated; with file and line
[[nodiscard]] record::ImuRecording read_imu(const ImuFileOptions& options, std::optional<geo::GpsTime> near = std::nullopt);

}  // namespace coast::io
