#pragma once
// Whether the innovations contradict the stated noise, and what noise would fit; private to the room.

#include <optional>
#include <vector>

#include "evidence/mission_run.hpp"

namespace coast::diagnose {

/// Largest deviation of the innovations' variance and of their lag-one correlation, in standard deviations of those of white
/// innovations with the stated size, over the components of position and velocity.
[[nodiscard]] double contradiction(const std::vector<estimate::InnovationRecord>& innovations);

/// Noise that maximises the likelihood of the innovations, if it is significantly better than the stated one (1 %).
struct FittedNoise {
  estimate::NoiseFit fit;
  std::vector<NoiseFinding> findings;
  [[nodiscard]] double gain() const { return fit.log_likelihood_after - fit.log_likelihood_before; }
};
/// @param before  an earlier fit: start of the search
[[nodiscard]] std::optional<FittedNoise> fitted_noise(const study::PreparedMission& mission,
                                                      const std::optional<estimate::NoiseFit>& before,
                                                      const study::Progress& progress);

}  // namespace coast::diagnose
