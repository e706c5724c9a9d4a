#pragma once
// One way through the epochs of a mission. Private to the room.

#include "coast/carrier/ppk.hpp"

namespace coast::carrier {

/// In order of time or against it; the result is in order of time.
/// @param options  with `air` and `noise` settled  @param interval  of the rover, s
std::vector<PpkEpoch> solve_pass(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options, double interval,
                                 bool backward, const std::function<void(double)>& progress);

/// What the residuals of a pass say of the noise: phases by those with integers, which leave three unknowns and the clocks;
/// codes by theirs against these positions, and by how long they are alike.
/// @param noise  that the pass was weighted with
NoiseScale estimate_noise(const std::vector<PpkEpoch>& epochs, const NoiseScale& noise);

/// The same of Doppler, against positions and velocities that are known well.
double estimate_rate_noise(const std::vector<DifferenceEpoch>& differences, const std::vector<PpkEpoch>& solved,
                           const DifferenceOptions& options);

/// Both ways in one.
std::vector<PpkEpoch> combine(const std::vector<PpkEpoch>& forward, const std::vector<PpkEpoch>& backward);

}  // namespace coast::carrier
