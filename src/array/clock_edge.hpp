#pragma once
// Shared by the fits of clocks. Private to the room.

#include <vector>

#include "coast/array/clock.hpp"
#include "robust_line.hpp"

namespace coast::array {

/// Sets offset, drift and residual statistics from the line through the clock.
void describe_clock(const RobustLine& line, std::vector<double> residuals, ClockFit& fit);

}  // namespace coast::array
