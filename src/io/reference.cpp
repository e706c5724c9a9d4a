#include "coast/io/reference.hpp"

#include "registry_lookup.hpp"

namespace coast::io {

ReferenceFileOptions ReferenceFileOptions::from(const config::Node& reference) {
  ReferenceFileOptions o;
  o.file = reference.at("file").path();
  o.table = reference.at("file").table();
  o.format = reference.text("format", "auto");
  o.position = PositionOptions::from(reference);
  o.time = TimeOptions::from(reference);
  o.topic = reference.text("topic", "");
  o.attitude.to_enu = reference.choice("attitude_to", {"ned", "enu"}, 0) == 1;
  o.attitude.body_flu = reference.choice("body_axes", {"frd", "flu"}, 0) == 1;
  const auto columns = reference.find("columns");
  if (!columns) return o;
  if (o.time.kind != TimeKind::kRow) o.time_columns = Column::list_from(columns->at("time"), 0);
  o.position_columns = Column::list_from(columns->at("position"), 3);
  if (const auto v = columns->find("velocity")) o.velocity_columns = Column::list_from(*v, 3);
  const auto euler = columns->find("euler");
  const auto quaternion = columns->find("quaternion");
  if (euler && quaternion) throw quaternion->error("both `euler` and `quaternion`", "one of them", "");
  if (euler) {
    o.attitude.form = AttitudeOptions::Form::kEuler;
    o.attitude_columns = Column::list_from(*euler, 3);
  } else if (quaternion) {
    o.attitude.form = AttitudeOptions::Form::kQuaternion;
    o.attitude_columns = Column::list_from(*quaternion, 4);
  }
  return o;
}

ReferenceFileOptions ReferenceFileOptions::of_file(const std::filesystem::path& file) {
  ReferenceFileOptions o;
  o.file = file;
  return o;
}

record::Trajectory read_reference(const ReferenceFileOptions& options, std::optional<geo::GpsTime> near) {
  // With mapped columns any text is a table, whatever its content.
  const std::string format =
      options.table || (options.format == "auto" && !options.position_columns.empty()) ? "csv" : options.format;
  return format_for(options.file, format, &Format::read_reference, "a trajectory").read_reference(options, near);
}

}  // namespace coast::io
