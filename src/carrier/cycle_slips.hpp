#pragma once
// Detection of cycle slips not flagged by the receivers. Private to the room.

#include "coast/carrier/differences.hpp"

namespace coast::carrier {

/// Renumbers the arcs of the differences: a new one if `arc` changes, and if one of three complementary tests detects a
/// slip:
///
/// - geometry-free (Blewitt 1990): the difference of two bands' phases jumps from one epoch to the next by more than noise and
///   ionosphere; for close receivers the ionosphere mostly cancels. Blind to 9 cycles of L1 with 7 of L2.
/// - Melbourne (1985), Wuebbena (1985): the wide lane of phases minus the narrow lane of codes leaves its mean for two epochs;
///   blind to equal slips of both bands.
/// - Doppler: the change of a phase differs from the mean Doppler of both epochs; for single bands too, at 2 s or less.
///
/// Remaining slips are left to the filter's tests.
void break_arcs(std::vector<DifferenceEpoch>& epochs);

}  // namespace coast::carrier
