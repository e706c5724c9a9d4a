#pragma once
// The fit of a stated sum. Private to the room.

#include "candidate.hpp"

namespace coast::noise {

/// Fits a stated sum to all samples, from the Allan curve and from the optima of sums of some of its processes: it is at
/// least as likely as each of those with a close optimum on extracts.
[[nodiscard]] Candidate fit_stated(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                                   const CalibrationOptions& options);

}  // namespace coast::noise
