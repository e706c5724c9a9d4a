#pragma once
// Plausibility of a filter solution: sensor states compared with the error model, samples compared with their noise.

#include <optional>
#include <string>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/record/imu.hpp"

namespace coast::study {

struct SensorError {
  std::string name;     ///< of the state, as in StateLayout
  double sigmas = 0.0;  ///< distance from its prior mean, in prior standard deviations
};
/// The sensor state that is farthest from its prior; nothing if no state has one.
[[nodiscard]] std::optional<SensorError> largest_sensor_error(const estimate::StateLayout& layout, const Eigen::VectorXd& x);

/// Squared innovations of the GNSS positions and velocities that were used, over their expectation: 1 if the noise is as
/// stated, or if there are none.
[[nodiscard]] double nis_over_expected(const std::vector<estimate::InnovationRecord>& innovations);

/// Scatter from sample to sample relative to that of the model's white noise, the larger of gyro and accelerometer, each the
/// median over seconds (1 for an IMU at rest): values well above 1 mean vibration.
[[nodiscard]] double vibration_over_white_noise(const record::ImuRecording& imu, const noise::ImuErrorModel& model);

/// The model without errors that multiply a signal: scale factors, misalignments and the like. If vibration is larger than the
/// motion, their regressor is mostly noise, and their estimates have no physical meaning.
[[nodiscard]] noise::ImuErrorModel without_gain_errors(const noise::ImuErrorModel& model, double rate_hz);
[[nodiscard]] bool has_gain_errors(const noise::ImuErrorModel& model);

}  // namespace coast::study
