#include <algorithm>
#include <cmath>

#include "coast/diagnose/effect.hpp"
#include "effects/effects.hpp"

namespace coast::diagnose {

const std::vector<Effect>& catalogue() {
  static const std::vector<Effect> effects{
      lever_arm_error(),
      gnss_time_offset(),
      gyro_scale_factor(),
      accel_scale_factor(),
      gyro_misalignment(),
      accel_misalignment(),
      gyro_g_sensitivity(),
      gyro_g2_sensitivity(),
      accel_nonlinearity_quadratic(),
      accel_sign_asymmetric_scale(),
      accel_size_effect(),
      gyro_temperature_bias(),
      accel_temperature_bias(),
      temperature_rate_hysteresis_gyro(),
      temperature_rate_hysteresis_accel(),
      vibration_rectification(),
      rate_ramp_gyro(),
      rate_ramp_accel(),
      bias_step_gyro(),
      bias_step_accel(),
      imu_clock_drift(),
      imu_timestamp_gap(),
      gnss_wrong_fix(),
      gnss_smoothing_lag(),
      antenna_mount_slip(),
      antenna_phase_center_heading_dependent(),
      base_coordinate_offset(),
      gravity_disturbance(),
      body_flexure(),
      imu_mount_rotation(),
      vehicle_mounting(),
      earth_rotation_omitted(),
      coning_omitted(),
  };
  return effects;
}

std::vector<std::string> three_axes() {
  return {"x", "y", "z"};
}

namespace {

std::vector<std::string> pairs(bool off_diagonal) {
  std::vector<std::string> names;
  for (const char response : {'x', 'y', 'z'})
    for (const char cause : {'x', 'y', 'z'})
      if (!off_diagonal || response != cause) names.push_back({response, cause});
  return names;
}

}  // namespace

std::vector<std::string> nine_pairs() {
  return pairs(false);
}

std::vector<std::string> six_pairs() {
  return pairs(true);
}

std::string_view name(Site site) {
  switch (site) {
    case Site::kGyro:
      return "gyro";
    case Site::kAccel:
      return "accel";
    case Site::kImu:
      return "imu";
    case Site::kGnss:
      return "gnss";
    case Site::kAntenna:
      return "antenna";
    case Site::kClock:
      return "clock";
    case Site::kGravity:
      return "gravity";
    case Site::kMount:
      return "mount";
  }
  return "";
}

std::string_view name(Grade grade) {
  switch (grade) {
    case Grade::kNavigation:
      return "navigation";
    case Grade::kTactical:
      return "tactical";
    case Grade::kIndustrial:
      return "industrial MEMS";
    case Grade::kConsumer:
      return "consumer MEMS";
  }
  return "";
}

Grade grade_of(const noise::ImuErrorModel& model) {
  double density = 0.0;
  for (int axis = 0; axis < 3; ++axis) density = std::max(density, model.white_density(noise::Sensor::kGyro, axis).value);
  const double degrees_per_root_hour = std::sqrt(density * geo::kHour) / geo::kDegree;
  if (degrees_per_root_hour < 0.03) return Grade::kNavigation;
  if (degrees_per_root_hour < 0.12) return Grade::kTactical;
  return degrees_per_root_hour < 0.5 ? Grade::kIndustrial : Grade::kConsumer;
}

double FixSignals::heading() const {
  const Eigen::Vector3d forward_n = C_n_e.transpose() * C_b_e.col(0);
  return std::atan2(forward_n.y(), forward_n.x());
}

}  // namespace coast::diagnose
