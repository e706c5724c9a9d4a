#pragma once
// Where phases slip although no receiver says so. Private to the room.

#include "coast/carrier/differences.hpp"

namespace coast::carrier {

/// Numbers the arcs of the differences anew: a new one wherever the number changes that stands in `arc`, and where one of
/// three tests says that a phase slipped, each blind to what another sees:
///
/// - geometry-free (Blewitt 1990): the difference of two bands' phases jumps from one epoch to the next by more than noise and
///   ionosphere do; of receivers near to each other the ionosphere is mostly gone. Blind to 9 cycles of L1 with 7 of L2.
/// - Melbourne (1985), Wuebbena (1985): the wide lane of phases less the narrow lane of codes leaves its mean for two epochs;
///   blind to equal slips of both bands.
/// - Doppler: a phase moves by other than the mean of the Doppler at both epochs; for single bands too, at 2 s or less.
///
/// What is left is for the filter's tests.
void break_arcs(std::vector<DifferenceEpoch>& epochs);

}  // namespace coast::carrier
