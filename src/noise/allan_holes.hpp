#pragma once
// Differences of averages of a signal with holes. Private to the room.

#include <span>
#include <vector>

#include "allan_differences.hpp"
#include "coast/noise/static_signal.hpp"

namespace coast::noise {

/// Sums of squared differences of averages over the available ones of m samples, if at least 3/4 are available; without holes
/// they equal those of `add_differences`. White noise averages to the variance of the available number of samples: with a
/// share p missing at random its Allan variance is larger by 1/(1 - p).
/// @param full_overlap  a term starts at every sample, else at every block of the factor's level
[[nodiscard]] std::vector<DifferenceSums> differences_with_holes(const StaticSignal& signal,
                                                                 std::span<const AveragingFactor> factors, bool full_overlap);

}  // namespace coast::noise
