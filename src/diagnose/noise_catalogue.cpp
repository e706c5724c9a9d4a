#include <cmath>

#include "coast/diagnose/correction.hpp"
#include "noise_effects/noise_effects.hpp"

namespace coast::diagnose {

const std::vector<NoiseEffect>& noise_catalogue() {
  static const std::vector<NoiseEffect> effects{
      extra_gauss_markov_bias(Site::kGyro), extra_gauss_markov_bias(Site::kAccel), flicker_noise(Site::kGyro),
      flicker_noise(Site::kAccel),          dynamics_dependent_noise(Site::kGyro), dynamics_dependent_noise(Site::kAccel),
  };
  return effects;
}

Eigen::ArrayXf gauss_markov_power(const Disturbances& d, const Eigen::MatrixXf& score, double time) {
  Eigen::ArrayXf r = Eigen::ArrayXf::Zero(score.rows());
  Eigen::ArrayXf sum = r;
  for (std::size_t k = d.t.size(); k-- > 0;) {
    r = static_cast<float>(std::exp(-d.length[k] / time)) * r + score.col(static_cast<Eigen::Index>(k)).array();
    sum += static_cast<float>(2.0 * d.length[k] / time) * r.square();
  }
  return sum + r.square();
}

void append(const std::vector<noise::ProcessPtr>& processes, noise::Sensor sensor, int axis, MissionInput& input) {
  noise::ImuErrorModel& model = input.setup.model;
  noise::ImuErrorModel::Axes gyro = model.axes(noise::Sensor::kGyro);
  noise::ImuErrorModel::Axes accel = model.axes(noise::Sensor::kAccel);
  auto& list = (sensor == noise::Sensor::kGyro ? gyro : accel)[static_cast<std::size_t>(axis)];
  list.insert(list.end(), processes.begin(), processes.end());
  model = noise::ImuErrorModel::of(model.sensor_name(), input.imu.rate_hz, std::move(gyro), std::move(accel));
}

}  // namespace coast::diagnose
