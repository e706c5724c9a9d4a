#pragma once
// Whether what a filter made of an IMU can be: its sensor states against the error model, its samples against their noise.

#include <optional>
#include <string>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/record/imu.hpp"

namespace coast::study {

struct SensorError {
  std::string name;     ///< of the state, as in StateLayout
  double sigmas = 0.0;  ///< from what the error model gives it beforehand, in its standard deviations
};
/// The sensor state that is farthest from its prior; nothing where no state has one.
[[nodiscard]] std::optional<SensorError> largest_sensor_error(const estimate::StateLayout& layout, const Eigen::VectorXd& x);

/// Squared innovations of the GNSS positions and velocities that were used, over their expectation: 1 where noise is as stated,
/// and where there are none.
[[nodiscard]] double nis_over_expected(const std::vector<estimate::InnovationRecord>& innovations);

/// Scatter from sample to sample over what the model's white noise makes of it, the larger of gyro and accelerometer, each the
/// median over seconds (1 for an IMU at rest): vibration, where it is above some units.
[[nodiscard]] double vibration_over_white_noise(const record::ImuRecording& imu, const noise::ImuErrorModel& model);

/// The model without what is multiplied by a signal: scale factors, misalignments and the like. Where vibration is larger than
/// the motion, their regressor is the noise itself, and what they are estimated as is not physics.
[[nodiscard]] noise::ImuErrorModel without_gain_errors(const noise::ImuErrorModel& model, double rate_hz);
[[nodiscard]] bool has_gain_errors(const noise::ImuErrorModel& model);

}  // namespace coast::study
