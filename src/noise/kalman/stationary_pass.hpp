#pragma once
// Passes with a constant gain from the first sample to the last. Private to the room.

#include <optional>

#include "passes.hpp"

namespace coast::noise {

/// As innovation_pass, exactly: the start is corrected afterwards (stationary_gain.hpp). None for a short record, one with
/// holes, or a filter that does not settle.
[[nodiscard]] std::optional<InnovationSums> stationary_innovations(const SampleBlock& block, const StaticSignal& signal);

/// As score_pass, without the information: the gradient by one pass backward, at the same cost for any number of parameters.
[[nodiscard]] std::optional<ScoreSums> stationary_score(const SampleBlock& block, const std::vector<SampleBlock>& derivatives,
                                                        const StaticSignal& signal, const MeanCurve& mean);

}  // namespace coast::noise
