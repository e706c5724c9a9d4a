#pragma once
// The size of a random effect that maximises the likelihood of a recording; private to the room.

#include "evidence/noise_scan.hpp"

namespace coast::diagnose {

/// A random effect with the most likely variance.
struct FittedEffect {
  AddedNoise noise;
  double log_sd = 0.0;       ///< of the root
  double log_time_sd = 0.0;  ///< of the correlation time; 0: unknown
  double gain = 0.0;         ///< logarithm of the likelihood ratio relative to none
};
/// Input of a run and its log-likelihood.
struct FilteredMission {
  const MissionInput& input;
  const estimate::StateLayout& layout;
  double log_likelihood = 0.0;
};
/// Upwards in steps of a factor, then the vertex of the parabola through the best three.
[[nodiscard]] FittedEffect fitted_effect(const AddedNoise& from, const FilteredMission& run);
/// Likewise at the likeliest correlation time: upwards from one at which the root is fitted, then interpolated between those
/// tested. The root's uncertainty includes that of the time.
[[nodiscard]] FittedEffect fitted_in_time(const FittedEffect& fit, const FilteredMission& run);

/// Prior cost of a random effect: its choice among all, and its size. @param log_sd  of the root of its variance
[[nodiscard]] double price_of_random_effect(double log_sd);
/// Gain in log-likelihood minus prior cost.
[[nodiscard]] double evidence_of(const FittedEffect& fit);

/// Sensor states of one layout in another one with more or fewer processes: new ones are zero.
[[nodiscard]] Eigen::VectorXd sensor_states_in(const estimate::StateLayout& to, const estimate::StateLayout& from,
                                               const Eigen::VectorXd& x);
/// The layout of the input's filter.
[[nodiscard]] estimate::StateLayout layout_of(const MissionInput& input);

}  // namespace coast::diagnose
