#pragma once
// Biases at the start beyond what the error model has of them; private to the room.

#include <vector>

#include "mission_run.hpp"

namespace coast::diagnose {

[[nodiscard]] inline Site sensor_site(noise::Sensor sensor) {
  return sensor == noise::Sensor::kGyro ? Site::kGyro : Site::kAccel;
}

/// A bias at the start that is larger than the error model has it. A filter follows it, and nothing else tells of it.
struct TurnOn {
  noise::Sensor sensor = noise::Sensor::kGyro;
  int axis = 0;         ///< of the sensor
  double value = 0.0;   ///< rad/s or m/s^2
  double sd = 0.0;      ///< as the run knows it
  double stated = 0.0;  ///< sd of the error model
  std::vector<Alternative> alternatives = {};
  /// What the bias costs in log-likelihood under the stated sd, against none.
  [[nodiscard]] double cost() const;
  /// Likewise under the sd that would make it likeliest, its own size.
  [[nodiscard]] double price() const;
  /// By that sd.
  [[nodiscard]] double gain() const;
};
/// Such as less than one in ten thousand missions has of which the error model holds.
[[nodiscard]] std::vector<TurnOn> beyond_stated(const MissionRun& run);
/// A run has its prior mean of the bias where the bias was found. As if it were the error model's: the bias and an effect that
/// is a constant during the mission share what is found, and a mean that follows the bias would hold for every share. By how
/// much log-likelihood that is more, and scores likewise.
[[nodiscard]] double gain_about_stated(const TurnOn& one, const MissionRun& run);
void move_to_stated(const TurnOn& one, const MissionRun& run, Examination& examination);

[[nodiscard]] NoiseFinding described_bias(const TurnOn& one);
/// A turn-on bias of this size, in the error model.
void widen(const TurnOn& one, MissionInput& input);

/// Of the effects that are a constant on the axis during this mission, the one whose size would be the most plausible: as if it
/// were all of the bias, known as well as the stated sd has it. Nothing where there is none.
[[nodiscard]] std::optional<Suspicion> constant_like(const TurnOn& one, const MissionRun& run);

}  // namespace coast::diagnose
