#include "coast/io/writers.hpp"

#include <Eigen/Geometry>

#include "text_buffer.hpp"

namespace coast::io {

void write_imu_csv(const std::filesystem::path& path, const record::ImuRecording& imu) {
  AtomicFile file(path);
  TextBuffer text(file);
  const bool temperature = !imu.temperature.empty();
  text.put("time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2");
  if (temperature) text.put(",temperature_degC");
  text.end_line();
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const record::ImuSample& s = imu.samples[i];
    text.put_fixed(s.t.sow(), 9);
    for (const double rate : Eigen::Vector3d(s.dtheta / s.dt)) {
      text.put(',');
      text.put_fixed(rate, 13);
    }
    for (const double force : Eigen::Vector3d(s.dv / s.dt)) {
      text.put(',');
      text.put_fixed(force, 12);
    }
    if (temperature) {
      text.put(',');
      text.put_fixed(static_cast<double>(imu.temperature[i]), 3);
    }
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
    text.put(std::to_string(sample.t.week()));
    text.put(',');
    text.put_fixed(sample.t.sow(), 9);
    text.put(',');
    text.put_fixed(sample.value.x(), 6);
    text.end_line();
  }
  text.flush();
  file.commit();
}

}  // namespace coast::io
