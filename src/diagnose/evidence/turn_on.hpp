#pragma once
// Start biases larger than the error model allows; private to the room.

#include <vector>

#include "evidence/mission_run.hpp"

namespace coast::diagnose {

[[nodiscard]] inline Site sensor_site(noise::Sensor sensor) {
  return sensor == noise::Sensor::kGyro ? Site::kGyro : Site::kAccel;
}

/// A start bias larger than the error model allows. A filter estimates it, so that it is not visible elsewhere.
struct TurnOn {
  noise::Sensor sensor = noise::Sensor::kGyro;
  int axis = 0;         ///< of the sensor
  double value = 0.0;   ///< rad/s or m/s^2
  double sd = 0.0;      ///< of the estimate in the run
  double stated = 0.0;  ///< sd of the error model
  std::vector<Alternative> alternatives = {};
  /// Decrease in log-likelihood by the bias under the stated sd, relative to no bias.
  [[nodiscard]] double cost() const;
  /// Likewise under the sd that maximises its likelihood, its own size.
  [[nodiscard]] double price() const;
  /// Decrease of the cost by that sd.
  [[nodiscard]] double gain() const;
};
/// Biases that occur in less than one in ten thousand missions if the error model is correct.
[[nodiscard]] std::vector<TurnOn> beyond_stated(const MissionRun& run);
/// A run uses the estimated bias as its prior mean. Gain in log-likelihood if this mean is that of the error model instead, and
/// what scores change by for each unit of information on the bias: the bias and an effect that is constant during the mission
/// share the estimate, and a mean equal to the estimate would suit every share.
[[nodiscard]] double gain_about_stated(const TurnOn& one, const MissionRun& run);
[[nodiscard]] double prior_mean(const TurnOn& one, const MissionRun& run);
[[nodiscard]] Eigen::Index constant_bias(const TurnOn& one, const MissionRun& run);  ///< its hypothesis

[[nodiscard]] NoiseFinding described_bias(const TurnOn& one);
/// Sets a turn-on bias of this size in the error model.
void widen(const TurnOn& one, MissionInput& input);

/// Of the effects that are constant on the axis during this mission, the one with the most plausible size if it explained all
/// of the bias, with the stated sd as uncertainty. None if there is no such effect.
[[nodiscard]] std::optional<Suspicion> constant_like(const TurnOn& one, const MissionRun& run);

}  // namespace coast::diagnose
