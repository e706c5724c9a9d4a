#include "coast/io/gnss.hpp"

#include "registry_lookup.hpp"

namespace coast::io {

namespace {

std::optional<Eigen::Vector3d> positive_vector(const config::Node& map, std::string_view key) {
  const auto node = map.find(key);
  if (!node) return std::nullopt;
  const Eigen::Vector3d v = node->vector3();
  if ((v.array() <= 0.0).any())
    throw node->error("a standard deviation that is not positive", "three numbers > 0 (N, E, D)", "");
  return v;
}

}  // namespace

GnssFileOptions GnssFileOptions::from(const config::Node& gnss) {
  GnssFileOptions o;
  o.file = gnss.at("file").path();
  o.table = gnss.at("file").table();
  o.format = gnss.text("format", "auto");
  o.position = PositionOptions::from(gnss);
  o.time = TimeOptions::from(gnss);
  o.topic = gnss.text("topic", "");
  o.sd = positive_vector(gnss, "sd_m");
  o.velocity_sd = positive_vector(gnss, "velocity_sd_mps");
  const auto columns = gnss.find("columns");
  if (!columns) return o;
  if (o.time.kind != TimeKind::kRow) o.time_columns = Column::list_from(columns->at("time"), 0);
  const auto three = [&](std::string_view key) {
    const auto node = columns->find(key);
    return node ? Column::list_from(*node, 3) : std::vector<Column>{};
  };
  o.position_columns = Column::list_from(columns->at("position"), 3);
  o.sd_columns = three("sd");
  o.velocity_columns = three("velocity");
  o.velocity_sd_columns = three("velocity_sd");
  if (const auto q = columns->find("quality")) o.quality_column = Column::from(*q);
  if (const auto n = columns->find("satellites")) o.satellites_column = Column::from(*n);
  return o;
}

record::GnssRecording read_gnss(const GnssFileOptions& options, std::optional<geo::GpsTime> near) {
  // With mapped columns any text is a table, whatever its content.
  const std::string format =
      options.table || (options.format == "auto" && !options.position_columns.empty()) ? "csv" : options.format;
  return format_for(options.file, format, &Format::read_gnss, "a GNSS").read_gnss(options, near);
}

}  // namespace coast::io
