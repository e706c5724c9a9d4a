#pragma once
// One pass through the epochs of a mission. Private to the room.

#include "coast/carrier/ppk.hpp"
#include "known_integers.hpp"

namespace coast::carrier {

struct Pass {
  std::vector<PpkEpoch> epochs;
  AmbiguityHistory ambiguities;
};

/// In time order or in reverse; the result is in time order.
/// @param options  with `air` and `noise` settled  @param interval  of the rover, s
Pass solve_pass(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options, double interval, bool backward,
                const KnownIntegers& known, const std::function<void(double)>& progress);

/// Noise estimated from the residuals of a pass: for phases from those with integers, leaving three unknowns and the clocks;
/// for codes from theirs relative to these positions, and from their correlation in time.
/// @param noise  used for the weights of the pass
NoiseScale estimate_noise(const std::vector<PpkEpoch>& epochs, const NoiseScale& noise);

/// Likewise for Doppler, relative to accurately known positions and velocities.
double estimate_rate_noise(const std::vector<DifferenceEpoch>& differences, const std::vector<PpkEpoch>& solved,
                           const DifferenceOptions& options);

/// Combines both passes.
std::vector<PpkEpoch> combine(const std::vector<PpkEpoch>& forward, const std::vector<PpkEpoch>& backward);

}  // namespace coast::carrier
