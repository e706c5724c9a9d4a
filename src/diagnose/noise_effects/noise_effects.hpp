#pragma once
// The functions that create the random effects, one file each, and shared functions; private to the room.

#include "../sample_effects/sample_effects.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/noise/process.hpp"

namespace coast::diagnose {

NoiseEffect extra_gauss_markov_bias(Site site);
NoiseEffect flicker_noise(Site site);
NoiseEffect dynamics_dependent_noise(Site site);

/// Sum of squares of a stationary Gauss-Markov error of unit variance: with r_k = exp(-h_k/T) r_{k+1} + a_k the score of one
/// that begins at k, 2/T sum h_k r_k^2 + r_0^2.
[[nodiscard]] Eigen::ArrayXf gauss_markov_power(const Disturbances& d, const Eigen::MatrixXf& score, double time);

/// Appends processes to an axis of the mission's error model.
void append(const std::vector<noise::ProcessPtr>& processes, noise::Sensor sensor, int axis, MissionInput& input);
[[nodiscard]] inline std::string_view signal_unit(Site site) {
  return site == Site::kGyro ? "rad/s" : "m/s^2";
}

}  // namespace coast::diagnose
