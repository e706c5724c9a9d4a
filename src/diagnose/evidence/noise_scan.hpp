#pragma once
// Random effects suggested by the disturbances, and the gain of each in likelihood; private to the room.

#include <optional>
#include <vector>

#include "coast/diagnose/examination.hpp"
#include "evidence/mission_run.hpp"

namespace coast::diagnose {

/// A random effect of one axis.
struct AddedNoise {
  const NoiseEffect* effect = nullptr;
  int axis = 0;
  double root = 0.0;  ///< of the variance
  double time = 0.0;  ///< s
  std::vector<geo::GpsTime> t = {};
  std::vector<double> level = {};
  bool operator==(const AddedNoise&) const = default;
  void add_to(MissionInput& input) const { effect->add(input, axis, root, time, t, level); }
};

/// Factor of the variance of an effect, in means over the intervals that begin at `t`; ones if it is constant.
[[nodiscard]] std::vector<double> level_of(const NoiseEffect& effect, const std::vector<geo::GpsTime>& t,
                                           const MissionRun& run);

/// Score test of one random effect.
struct NoiseSuspicion {
  AddedNoise noise;               ///< with the root from one step of scoring
  double likelihood_ratio = 0.0;  ///< the square of a standard normal value of equal probability
  double p_value = 1.0;           ///< that the largest of all is as large by chance
};
struct NoiseSuspicions {
  std::vector<NoiseSuspicion> all;  ///< those with a variance above zero
  LargestByChance chance;
};
[[nodiscard]] NoiseSuspicions noise_suspicions(const Examination& examination, const MissionRun& run);

}  // namespace coast::diagnose
