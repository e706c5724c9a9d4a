#pragma once
// Last stage of the model choice, with all samples of a long record. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// Continues from the best candidate: grows and shrinks the sum as long as the criterion on the record's spectrum gains,
/// which costs little and uses every sample. Steps are those of the search on extracts, and one more: an AR(2) with its
/// resonance at a narrow band of power that the sum does not explain. The first and the last sum and close neighbours of the
/// last are then fitted to all samples by maximum likelihood and added to the candidates.
void refine(const std::vector<StaticSignal>& records, const CalibrationOptions& options, std::vector<Candidate>& candidates);

}  // namespace coast::noise
