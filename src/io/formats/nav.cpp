// `.nav`: week, second of week, latitude, longitude [deg], height [m], v N E D [m/s], roll, pitch, yaw [deg]; white space.
// Week 0 means "not stated": written by KF-GINS.

#include "../reference_table.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_nav(const FileHead& head) {
  const auto rows = numeric_rows(head, 3);
  if (rows.empty()) return false;
  for (const auto& r : rows) {
    if (r.size() != 11) return false;
    const bool plausible = r[0] >= 0.0 && r[0] < 10000.0 && r[0] == static_cast<double>(static_cast<long>(r[0])) &&
                           r[1] >= 0.0 && r[1] <= 604800.0 && r[2] >= -90.0 && r[2] <= 90.0 && r[3] >= -180.0 && r[3] <= 360.0;
    if (!plausible) return false;
  }
  return true;
}

record::Trajectory read_nav(const ReferenceFileOptions& given, Format::Near near) {
  ReferenceFileOptions o = given;
  o.time.kind = TimeKind::kWeekAndSeconds;
  o.time_columns = {1, 2};
  o.position_columns = {3, 4, 5};
  o.velocity_columns = {6, 7, 8};
  o.attitude_columns = {9, 10, 11};
  o.attitude.form = AttitudeOptions::Form::kEuler;
  TableReader table(o.file);
  return read_reference_table(table, o, near);
}

}  // namespace

Format nav_format() {
  return {"nav", "week sow lat lon h vn ve vd roll pitch yaw (KF-GINS and coast)", sniff_nav, {}, {}, read_nav};
}

}  // namespace coast::io
