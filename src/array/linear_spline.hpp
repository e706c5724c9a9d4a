#pragma once
// A broken line through points of which some are wrong. Private to the room.

#include <vector>

#include "robust_line.hpp"

namespace coast::array {

/// Values at knots, straight between them.
struct LinearSpline {
  std::vector<double> knots;   ///< increasing
  std::vector<double> values;  ///< at the knots
  std::vector<double> sigmas;  ///< of the values, from the scatter of the points
};

/// Weighted robust fit (the same M-estimate as `fit_line`), O(points).
/// @param knots  increasing, every one at the x of a point; the first and last at the first and last point, so that every value
///               is determined
[[nodiscard]] LinearSpline fit_spline(const std::vector<LinePoint>& points, std::vector<double> knots);

}  // namespace coast::array
