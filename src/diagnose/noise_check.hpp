#pragma once
// Whether the innovations contradict the noise that is stated, and what noise would fit; private to the room.

#include <optional>
#include <vector>

#include "mission_run.hpp"

namespace coast::diagnose {

/// Largest deviation of the innovations' variance and of their correlation from one to the next, in standard deviations of what
/// white innovations of the stated size show, over the components of position and velocity.
[[nodiscard]] double contradiction(const std::vector<estimate::InnovationRecord>& innovations);

/// Noise that makes the innovations likeliest, where it is likelier than the stated one beyond chance (1 %).
struct FittedNoise {
  estimate::NoiseFit fit;
  std::vector<NoiseFinding> findings;
  [[nodiscard]] double gain() const { return fit.log_likelihood_after - fit.log_likelihood_before; }
};
/// @param before  an earlier fit: where the search begins
[[nodiscard]] std::optional<FittedNoise> fitted_noise(const study::PreparedMission& mission,
                                                      const std::optional<estimate::NoiseFit>& before,
                                                      const study::Progress& progress);

}  // namespace coast::diagnose
