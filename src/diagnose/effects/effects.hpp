#pragma once
// The functions that create the catalogue's effects, one file each; private to the room.

#include "coast/diagnose/effect.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::diagnose {

Effect accel_misalignment();
Effect accel_nonlinearity_quadratic();
Effect accel_scale_factor();
Effect accel_sign_asymmetric_scale();
Effect accel_size_effect();
Effect accel_temperature_bias();
Effect antenna_mount_slip();
Effect antenna_phase_center_heading_dependent();
Effect base_coordinate_offset();
Effect bias_step_accel();
Effect bias_step_gyro();
Effect body_flexure();
Effect coning_omitted();
Effect earth_rotation_omitted();
Effect gnss_smoothing_lag();
Effect gnss_time_offset();
Effect gnss_wrong_fix();
Effect gravity_disturbance();
Effect gyro_g2_sensitivity();
Effect gyro_g_sensitivity();
Effect gyro_misalignment();
Effect gyro_scale_factor();
Effect gyro_temperature_bias();
Effect imu_clock_drift();
Effect imu_mount_rotation();
Effect imu_timestamp_gap();
Effect lever_arm_error();
Effect rate_ramp_accel();
Effect rate_ramp_gyro();
Effect temperature_rate_hysteresis_accel();
Effect temperature_rate_hysteresis_gyro();
Effect vehicle_mounting();
Effect vibration_rectification();

/// Calls `take(column, response, cause)` for every pair, in the order of nine_pairs(); of six_pairs() for `off_diagonal`.
template <typename Take>
void for_each_pair(bool off_diagonal, const Take& take) {
  Eigen::Index column = 0;
  for (Eigen::Index response = 0; response < 3; ++response)
    for (Eigen::Index cause = 0; cause < 3; ++cause)
      if (!off_diagonal || response != cause) take(column++, response, cause);
}

inline constexpr double kDegreePerHour = geo::kDegree / geo::kHour;
inline constexpr double kMilliG = 1e-3 * geo::kStandardGravity;

}  // namespace coast::diagnose
