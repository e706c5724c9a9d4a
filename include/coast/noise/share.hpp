#pragma once
// Errors of a recording that is the weighted sum of several IMUs, its members.

#include <string>

#include "coast/noise/process.hpp"

namespace coast::noise {

/// A process of one member as it acts in the sum. Its states and their noise are the member's own; outputs and densities are
/// multiplied by the weight. Rounding by the member is not rounding of the sum: it is replaced by the white noise that a filter
/// uses for it.
/// @param weight  up to 1; below 0 if the member's axis is opposite to that of the sum
[[nodiscard]] ProcessPtr make_share(ProcessPtr own, const std::string& member, double weight, Sensor sensor);

}  // namespace coast::noise
