#pragma once
// Continued search if a record's Allan curve contradicts the chosen sum. Private to the room.

#include "calibration_checks.hpp"
#include "work_progress.hpp"

namespace coast::noise {

/// The band of the chosen sum. If the record is outside, the search continues: neighbours of that sum are fitted, and the best
/// one is chosen that gains at the lower level of evidence (candidate.hpp) and whose band contains the record; if there is none
/// the choice is kept.
/// @param candidates  those tried so far; neighbours are added
/// @param chosen      index among these: in, out
/// @param work        what `options` report to
[[nodiscard]] CurveBand settle_contradiction(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                             const CalibrationOptions& options, std::vector<Candidate>& candidates,
                                             std::size_t& chosen, WorkProgress& work);

}  // namespace coast::noise
