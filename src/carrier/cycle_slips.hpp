#pragma once
// Where phases slip although no receiver says so. Private to the room.

#include "coast/carrier/differences.hpp"

namespace coast::carrier {

/// Numbers the arcs of the differences anew: a new one wherever the number changes that stands in `arc`, and for both bands
/// where the difference of their phases jumps from one epoch to the next by more than noise and ionosphere do (Blewitt 1990:
/// the geometry-free combination; of receivers near to each other the ionosphere is mostly gone). A slip that moves both bands
/// equally is left to the filter's tests.
void break_arcs(std::vector<DifferenceEpoch>& epochs);

}  // namespace coast::carrier
