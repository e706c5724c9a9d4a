// The text files of KF-GINS: IMU `sow dtheta[3] dvel[3]` (rad, m/s), GNSS `sow lat lon h sdn sde sdd [vn ve vd sdvn sdve
// sdvd]`.

#include <cmath>

#include "../gnss_table.hpp"
#include "../imu_table.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool is_second_of_week(double t) {
  return t >= 0.0 && t <= 604800.0;
}

bool sniff_imu_or_gnss(const FileHead& head) {
  const auto rows = numeric_rows(head, 3);
  if (rows.empty()) return false;
  for (const auto& r : rows)
    if ((r.size() != 7 && r.size() != 13) || !is_second_of_week(r[0])) return false;
  return true;
}

record::ImuRecording read_kf_imu(const ImuFileOptions& given, Format::Near near) {
  ImuFileOptions o = given;
  o.increments = true;
  o.time_columns = {1};
  o.gyro_columns = {2, 3, 4};
  o.accel_columns = {5, 6, 7};
  TableReader table(o.file);
  return read_imu_table(table, o, near);
}

record::GnssRecording read_kf_gnss(const GnssFileOptions& given, Format::Near near) {
  GnssFileOptions o = given;
  TableReader table(o.file);
  o.time_columns = {1};
  o.position_columns = {2, 3, 4};
  o.sd_columns = {5, 6, 7};
  if (table.columns() >= 13) {
    o.velocity_columns = {8, 9, 10};
    o.velocity_sd_columns = {11, 12, 13};
  }
  return read_gnss_table(table, o, near);
}

}  // namespace

Format kf_gins_format() {
  return {"kf-gins",         "KF-GINS text: sow dtheta[3] dvel[3]; sow lat lon h sdn sde sdd [velocity]",
          sniff_imu_or_gnss, read_kf_imu,
          read_kf_gnss,      {}};
}

}  // namespace coast::io
