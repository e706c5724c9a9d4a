#include "coast/io/imu.hpp"

#include <fmt/format.h>

#include "imu_units.hpp"
#include "registry_lookup.hpp"

namespace coast::io {

namespace {

BinaryLayout binary_from(const config::Node& node) {
  BinaryLayout layout;
  layout.type = static_cast<BinaryLayout::Type>(node.choice("type", {"i16", "i32", "f32", "f64"}, 0));
  layout.row = static_cast<int>(node.integer("row", 0));
  layout.header_bytes = node.integer("header_bytes", 0);
  layout.big_endian = node.choice("byte_order", {"little", "big"}, 0) == 1;
  if (layout.row < 0 || layout.row > 4096) throw node.error("`row` out of range", "1 to 4096 numbers per record", "");
  if (layout.header_bytes < 0) throw node.error("negative `header_bytes`", ">= 0", "");
  return layout;
}

}  // namespace

ImuFileOptions ImuFileOptions::from(const config::Node& imu) {
  ImuFileOptions o;
  o.file = imu.at("file").path();
  o.table = imu.at("file").table();
  o.format = imu.text("format", "auto");
  o.increments = imu.choice("values", {"rates", "increments"}, 0) == 1;
  o.time = TimeOptions::from(imu);
  o.topic = imu.text("topic", "");
  o.time_tag = static_cast<TimeTag>(imu.choice("time_tag", {"end", "centre", "start"}, 0));
  if (const auto columns = imu.find("columns")) {
    if (o.time.kind != TimeKind::kRow) o.time_columns = Column::list_from(columns->at("time"), 0);
    o.gyro_columns = Column::list_from(columns->at("gyro"), 3);
    o.accel_columns = Column::list_from(columns->at("accel"), 3);
    if (const auto t = columns->find("temperature")) o.temperature_column = Column::from(*t);
  }
  const ImuFactors factors = imu_factors(imu, o.increments);
  o.gyro_to_si = factors.gyro;
  o.accel_to_si = factors.accel;
  if (const auto binary = imu.find("binary")) o.binary = binary_from(*binary);
  return o;
}

record::ImuRecording read_imu(const ImuFileOptions& options, std::optional<geo::GpsTime> near) {
  // With mapped columns any text is a table, whatever its content.
  const std::string format =
      options.table || (options.format == "auto" && !options.gyro_columns.empty()) ? "csv" : options.format;
  return format_for(options.file, format, &Format::read_imu, "an IMU").read_imu(options, near);
}

}  // namespace coast::io
