#pragma once
// A piecewise linear curve through points with outliers. Private to the room.

#include <vector>

#include "robust_line.hpp"

namespace coast::array {

/// Values at knots, linear between them.
struct LinearSpline {
  std::vector<double> knots;   ///< increasing
  std::vector<double> values;  ///< at the knots
  std::vector<double> sigmas;  ///< of the values, from the scatter of the points
};

/// Weighted robust fit (the same M-estimate as `fit_line`), O(points).
/// @param knots  increasing, each at the x of a point; the first and last at the first and last point, so that every value
///               is determined
[[nodiscard]] LinearSpline fit_spline(const std::vector<LinePoint>& points, std::vector<double> knots);

}  // namespace coast::array
