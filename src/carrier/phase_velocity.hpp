#pragma once
// Velocities from phases that did not slip between epochs. Private to the room.

#include "coast/carrier/ppk.hpp"

namespace coast::carrier {

/// Gives epochs the mean velocity over their neighbouring intervals, by time differences of double-differenced phases,
/// where it is better than what they have. Its covariance counts noise and the change of acceleration within the intervals,
/// which the mean does not follow: at 10 Hz that is little, at 1 Hz in a car decimetres a second.
void add_phase_velocities(const std::vector<DifferenceEpoch>& epochs, const NoiseScale& noise, const DifferenceOptions& options,
                          std::vector<PpkEpoch>& solved);

}  // namespace coast::carrier
