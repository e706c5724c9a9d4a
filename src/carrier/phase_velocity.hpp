#pragma once
// Velocities from phases without slips between epochs. Private to the room.

#include "coast/carrier/ppk.hpp"

namespace coast::carrier {

/// Sets the mean velocity over neighbouring intervals of an epoch, from time differences of double-differenced phases,
/// if it is better than the existing one. Its covariance includes noise and the change of acceleration within the intervals,
/// which the mean does not follow: at 10 Hz that is little, at 1 Hz in a car some decimetres per second.
void add_phase_velocities(const std::vector<DifferenceEpoch>& epochs, const NoiseScale& noise, const DifferenceOptions& options,
                          std::vector<PpkEpoch>& solved);

}  // namespace coast::carrier
