#pragma once
// The last part of the model choice, with all samples of a long record. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// Goes on from the best of the candidates: grows and shrinks the sum as long as the criterion on the record's spectrum gains,
/// which costs little and sees every sample. Steps are those of the search on extracts, and one more: an AR(2) with its
/// resonance where there is power in a narrow band that the sum does not explain. Where it started, what it came to and close
/// neighbours of that are then fitted to all samples by maximum likelihood and added to the candidates.
void refine(const std::vector<StaticSignal>& records, const CalibrationOptions& options, std::vector<Candidate>& candidates);

}  // namespace coast::noise
