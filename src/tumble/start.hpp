#pragma once
// First values of the unknowns, close enough for a linearised adjustment.

#include "adjustment.hpp"

namespace coast::tumble {

/// Bias and one common scale of the accelerometers from the sphere through the rests' specific forces; one common gain of
/// the gyros from the turns, their bias as at rest; attitudes from the gyros, levelled at each rest.
/// @param heading  of the first pose, rad
/// @throws InputError  poses that lie in one plane
[[nodiscard]] State start_of(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                             double heading);

/// Where gyros and accelerometers disagree about the turns although each by itself is right: the axes or the unit that would
/// make them agree.
/// @throws InputError  with the line to write
void require_agreement(const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                       const State& start);

}  // namespace coast::tumble
