#include "coast/study/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace coast::study {

std::optional<SensorError> largest_sensor_error(const estimate::StateLayout& layout, const Eigen::VectorXd& x) {
  const Eigen::VectorXd prior = layout.initial_covariance().diagonal().cwiseSqrt();
  const Eigen::VectorXd mean = layout.mean(0.0);
  std::optional<SensorError> largest;
  for (const auto& block : layout.sensors())
    for (int i = block.offset; i < block.offset + block.size; ++i) {
      if (!(prior(i) > 0.0)) continue;
      const double sigmas = std::abs(x(i) - mean(i)) / prior(i);
      if (!largest || sigmas > largest->sigmas) largest = SensorError{block.name, sigmas};
    }
  return largest;
}

double nis_over_expected(const std::vector<estimate::InnovationRecord>& innovations) {
  double nis = 0.0, dof = 0.0;
  for (const estimate::InnovationRecord& r : innovations) {
    if (!r.used || !(estimate::is_position(r.kind) || r.kind == estimate::UpdateKind::kGnssVelocity)) continue;
    nis += r.nis;
    dof += r.dof;
  }
  return dof > 0.0 ? nis / dof : 1.0;
}

namespace {

constexpr std::size_t kAxes = 3;

double white_sd(const noise::ImuErrorModel& model, noise::Sensor sensor, double rate_hz) {
  double density = 0.0;
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    density = std::max(density, model.white_density(sensor, static_cast<int>(axis)).value);
  return std::sqrt(density * rate_hz);
}

// Differences of adjacent samples: a vehicle's motion within a sample is small, vibration is not.
double scatter(const record::ImuRecording& imu, const Eigen::Vector3d record::ImuSample::*increment) {
  std::vector<double> seconds;
  const auto n = static_cast<std::size_t>(std::max(2.0, imu.rate_hz));
  for (std::size_t first = 1; first + n <= imu.samples.size(); first += n) {
    double squares = 0.0;
    for (std::size_t i = first; i < first + n; ++i) {
      const record::ImuSample &a = imu.samples[i - 1], &b = imu.samples[i];
      squares += (b.*increment / b.dt - a.*increment / a.dt).squaredNorm() / (2.0 * static_cast<double>(kAxes));
    }
    seconds.push_back(std::sqrt(squares / static_cast<double>(n)));
  }
  if (seconds.empty()) return 0.0;
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

}  // namespace

double vibration_over_white_noise(const record::ImuRecording& imu, const noise::ImuErrorModel& model) {
  const double gyro = white_sd(model, noise::Sensor::kGyro, imu.rate_hz);
  const double accel = white_sd(model, noise::Sensor::kAccel, imu.rate_hz);
  return std::max(gyro > 0.0 ? scatter(imu, &record::ImuSample::dtheta) / gyro : 0.0,
                  accel > 0.0 ? scatter(imu, &record::ImuSample::dv) / accel : 0.0);
}

noise::ImuErrorModel without_gain_errors(const noise::ImuErrorModel& model, double rate_hz) {
  const auto additive = [&](noise::Sensor sensor) {
    auto axes = model.axes(sensor);
    for (auto& axis : axes) std::erase_if(axis, [](const auto& process) { return process->input() != noise::Input::kOne; });
    return axes;
  };
  return noise::ImuErrorModel::of(model.sensor_name(), rate_hz, additive(noise::Sensor::kGyro),
                                  additive(noise::Sensor::kAccel));
}

bool has_gain_errors(const noise::ImuErrorModel& model) {
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    for (const auto& axis : model.axes(sensor))
      if (std::ranges::any_of(axis, [](const auto& process) { return process->input() != noise::Input::kOne; })) return true;
  return false;
}

}  // namespace coast::study
