// Tables with a header line, or with columns mapped by the configuration: CSV with any delimiter, white space included.

#include <algorithm>
#include <array>

#include "../file_kind.hpp"
#include "../gnss_table.hpp"
#include "../imu_table.hpp"
#include "../reference_table.hpp"
#include "../text.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

/// Text at least up to the end of the first line; later zero bytes are reported by the reader, with their line.
bool looks_like_text_table(const FileHead& head) {
  const std::size_t line_end = std::min(head.text.find('\n'), head.text.size());
  return !head.text.empty() && head.text.find('\0') >= line_end;
}

Column if_present(const TableReader& table, const char* name) {
  return table.has(name) ? Column(name) : Column();
}

std::vector<Column> three_if_present(const TableReader& table, const std::array<const char*, 3>& names) {
  if (!table.has(names[0]) || !table.has(names[1]) || !table.has(names[2])) return {};
  return {names.begin(), names.end()};
}

record::ImuRecording read_imu_columns(const ImuFileOptions& given, Format::Near near) {
  ImuFileOptions o = given;
  TableReader table = table_reader(o.file, o.table);
  default_time_columns(table, o.time, o.time_columns);
  if (o.gyro_columns.empty()) {
    o.gyro_columns = {"gyro_x_radps", "gyro_y_radps", "gyro_z_radps"};
    o.accel_columns = {"accel_x_mps2", "accel_y_mps2", "accel_z_mps2"};
    o.temperature_column = if_present(table, "temperature_degC");
  }
  return read_imu_table(table, o, near);
}

record::GnssRecording read_gnss_columns(const GnssFileOptions& given, Format::Near near) {
  GnssFileOptions o = given;
  TableReader table = table_reader(o.file, o.table);
  default_time_columns(table, o.time, o.time_columns);
  if (o.position_columns.empty()) {
    o.position_columns = {"lat_deg", "lon_deg", "height_m"};
    o.sd_columns = three_if_present(table, {"sdn_m", "sde_m", "sdd_m"});
    o.velocity_columns = three_if_present(table, {"vn_mps", "ve_mps", "vd_mps"});
    o.velocity_sd_columns = three_if_present(table, {"sdvn_mps", "sdve_mps", "sdvd_mps"});
    o.quality_column = if_present(table, "quality");
    o.satellites_column = if_present(table, "satellites");
  }
  return read_gnss_table(table, o, near);
}

record::Trajectory read_reference_csv(const ReferenceFileOptions& given, Format::Near near) {
  ReferenceFileOptions o = given;
  TableReader table = table_reader(o.file, o.table);
  default_time_columns(table, o.time, o.time_columns);
  if (o.position_columns.empty()) {
    o.position_columns = {"lat_deg", "lon_deg", "height_m"};
    o.velocity_columns = three_if_present(table, {"vn_mps", "ve_mps", "vd_mps"});
    o.attitude_columns = three_if_present(table, {"roll_deg", "pitch_deg", "yaw_deg"});
    if (!o.attitude_columns.empty()) o.attitude.form = AttitudeOptions::Form::kEuler;
  }
  return read_reference_table(table, o, near);
}

// After a read error, a file that is not a table is distinguished from a damaged one.
record::ImuRecording read_imu_csv(const ImuFileOptions& given, Format::Near near) {
  try {
    return read_imu_columns(given, near);
  } catch (const InputError&) {
    if (!given.table) refuse_other_kind(given.file, FileKind::Content::kImu, "a table of an IMU");
    throw;
  }
}

record::GnssRecording read_gnss_csv(const GnssFileOptions& given, Format::Near near) {
  try {
    return read_gnss_columns(given, near);
  } catch (const InputError&) {
    if (!given.table) refuse_other_kind(given.file, FileKind::Content::kPositions, "a table of positions");
    throw;
  }
}

}  // namespace

Format csv_format() {
  return {"csv",
          "table with a header line or with `columns`; comma, semicolon, tab or white space",
          looks_like_text_table,
          read_imu_csv,
          read_gnss_csv,
          read_reference_csv};
}

}  // namespace coast::io
