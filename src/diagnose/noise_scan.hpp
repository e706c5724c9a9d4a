#pragma once
// Which random effects the disturbances suggest, and how much likelier each makes the recording; private to the room.

#include <optional>
#include <vector>

#include "coast/diagnose/examination.hpp"
#include "mission_run.hpp"

namespace coast::diagnose {

/// A random effect of one axis.
struct AddedNoise {
  const NoiseEffect* effect = nullptr;
  int axis = 0;
  double root = 0.0;  ///< of the variance
  double time = 0.0;  ///< s
  std::vector<geo::GpsTime> t = {};
  std::vector<double> level = {};
  void add_to(MissionInput& input) const { effect->add(input, axis, root, time, t, level); }
};

/// What the variance of an effect is proportional to, in means over the intervals that begin at `t`; ones where it is constant.
[[nodiscard]] std::vector<double> level_of(const NoiseEffect& effect, const std::vector<geo::GpsTime>& t,
                                           const MissionRun& run);

/// Score test of one random effect.
struct NoiseSuspicion {
  AddedNoise noise;               ///< with the root that one step of scoring gives
  double likelihood_ratio = 0.0;  ///< the square of a normal number that is exceeded as rarely
  double p_value = 1.0;           ///< that the largest of all is as large by chance
};
struct NoiseSuspicions {
  std::vector<NoiseSuspicion> all;  ///< those whose variance is above zero
  LargestByChance chance;
};
[[nodiscard]] NoiseSuspicions noise_suspicions(const Examination& examination, const MissionRun& run);

/// A random effect with the variance that makes the recording likeliest.
struct FittedEffect {
  AddedNoise noise;
  double log_sd = 0.0;       ///< of the root
  double log_time_sd = 0.0;  ///< of the correlation time; 0: not known
  double gain = 0.0;         ///< logarithm of the likelihood ratio against none
};
/// @param input  of the run, which has the log-likelihood `without`  @param layout  of its filter
[[nodiscard]] FittedEffect fitted_effect(const AddedNoise& from, const MissionInput& input, const estimate::StateLayout& layout,
                                         double without);

/// Sensor states of one layout in another that has more processes: what is new is zero.
[[nodiscard]] Eigen::VectorXd sensor_states_in(const estimate::StateLayout& to, const estimate::StateLayout& from,
                                               const Eigen::VectorXd& x);
/// The layout that a filter of the input has.
[[nodiscard]] estimate::StateLayout layout_of(const MissionInput& input);

}  // namespace coast::diagnose
