#pragma once
// Errors of a recording that is the weighted sum of several IMUs, its members.

#include <string>

#include "coast/noise/process.hpp"

namespace coast::noise {

/// A process of one member as it acts in the sum. Its states and their noise are the member's own; outputs and densities are
/// multiplied with the weight. What the member rounds the sum does not round: it counts as the white noise that a filter takes
/// it for.
/// @param weight  up to 1; below 0 where the member's axis points against that of the sum
[[nodiscard]] ProcessPtr make_share(ProcessPtr own, const std::string& member, double weight, Sensor sensor);

}  // namespace coast::noise
