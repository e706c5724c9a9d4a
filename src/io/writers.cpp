#include "coast/io/writers.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "state_columns.hpp"
#include "text.hpp"

namespace coast::io {

namespace {

void put_week_and_time(TextBuffer& text, geo::GpsTime t) {
  text.put_integer(t.week());
  put_column(text, t.sow(), 9);
}

void put_vector_columns(TextBuffer& text, const Eigen::Vector3d& v, int decimals) {
  for (const double component : v) put_column(text, component, decimals);
}

std::string_view edge_name(record::Edge edge) {
  switch (edge) {
    case record::Edge::kRising:
      return "rising";
    case record::Edge::kFalling:
      return "falling";
    case record::Edge::kNotStated:
      break;
  }
  return "";
}

/// Columns that every fix has.
struct FixColumns {
  bool velocity, satellites;
};

void put_fix(TextBuffer& text, const record::GnssFix& fix, const FixColumns& columns) {
  put_time_and_place(text, fix.t, geo::geodetic_from_ecef(fix.r_ea_e));
  put_vector_columns(text, fix.position_cov_n.diagonal().cwiseSqrt(), 5);
  if (columns.velocity) {
    put_vector_columns(text, fix.velocity->v_ea_n, 6);
    put_vector_columns(text, fix.velocity->cov_n.diagonal().cwiseSqrt(), 6);
  }
  text.put(',');
  text.put_integer(static_cast<int>(fix.quality));
  if (columns.satellites) {
    text.put(',');
    text.put_integer(*fix.satellites);
  }
  text.end_line();
}

}  // namespace

void write_imu_csv(const std::filesystem::path& path, const record::ImuRecording& imu, WeekColumn week) {
  AtomicFile file(path);
  TextBuffer text(file);
  const bool temperature = !imu.temperature.empty();
  text.put(week == WeekColumn::kWith ? "gps_week,sow_s" : "time_s");
  text.put(",gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2");
  if (temperature) text.put(",temperature_degC");
  text.end_line();
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const record::ImuSample& s = imu.samples[i];
    if (week == WeekColumn::kWith)
      put_week_and_time(text, s.t);
    else
      text.put_fixed(s.t.sow(), 9);
    put_vector_columns(text, s.dtheta / s.dt, 13);
    put_vector_columns(text, s.dv / s.dt, 12);
    if (temperature) put_column(text, static_cast<double>(imu.temperature[i]), 3);
    text.end_line();
  }
  text.flush();
  file.commit();
}

void write_gnss_csv(const std::filesystem::path& path, const record::GnssRecording& gnss) {
  AtomicFile file(path);
  TextBuffer text(file);
  const FixColumns columns{
      std::ranges::all_of(gnss.fixes, [](const record::GnssFix& fix) { return fix.velocity.has_value(); }),
      std::ranges::all_of(gnss.fixes, [](const record::GnssFix& fix) { return fix.satellites.has_value(); })};
  text.put(kTimeAndPlaceColumns);
  text.put(",sdn_m,sde_m,sdd_m");
  if (columns.velocity) text.put(",vn_mps,ve_mps,vd_mps,sdvn_mps,sdve_mps,sdvd_mps");
  text.put(columns.satellites ? ",quality,satellites" : ",quality");
  text.end_line();
  for (const record::GnssFix& fix : gnss.fixes) put_fix(text, fix, columns);
  text.flush();
  file.commit();
}

void write_time_marks_csv(const std::filesystem::path& path, const record::TimeMarkRecording& marks) {
  AtomicFile file(path);
  TextBuffer text(file);
  text.put("gps_week,sow_s,sd_s,channel,edge,count,id");
  text.end_line();
  for (const record::TimeMark& mark : marks.marks) {
    put_week_and_time(text, mark.t);
    if (mark.sd_s > 0.0)
      put_column(text, mark.sd_s, 9);
    else
      text.put(',');
    text.put(',');
    text.put_integer(mark.channel);
    text.put(',');
    text.put(edge_name(mark.edge));
    text.put(',');
    text.put_integer(mark.count);
    text.put(',');
    text.put(csv_field(mark.id));
    text.end_line();
  }
  text.flush();
  file.commit();
}

void write_aid_csv(const std::filesystem::path& path, const record::AidRecording& aid, std::string_view column) {
  AtomicFile file(path);
  TextBuffer text(file);
  text.put("gps_week,sow_s,");
  text.put(column);
  text.end_line();
  for (const record::AidSample& sample : aid.samples) {
    put_week_and_time(text, sample.t);
    put_column(text, sample.value.x(), 6);
    text.end_line();
  }
  text.flush();
  file.commit();
}

}  // namespace coast::io
