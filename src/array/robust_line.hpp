#pragma once
// A straight line through points with outliers. Private to the room.

#include <vector>

namespace coast::array {

struct LinePoint {
  double x = 0.0;
  double y = 0.0;
  double sigma = 1.0;  ///< of y, > 0
};

struct RobustLine {
  double reference = 0.0;
  double value = 0.0;  ///< at the reference
  double slope = 0.0;
  double value_sigma = 0.0;
  double slope_sigma = 0.0;
  double scale = 1.0;           ///< scatter relative to the given sigmas
  std::vector<double> weights;  ///< [0, 1] per point, from the fit

  [[nodiscard]] double at(double x) const { return value + slope * (x - reference); }
};

enum class Sigmas {
  kRelative,  ///< only their ratios are known: the scatter determines the scale
  kAbsolute,  ///< a larger scatter raises the standard errors, a smaller one does not lower them
};

/// M-estimate with Tukey's biweight (c = 4.685: 95 % efficient for normal errors) from a Huber start, scale by the median
/// absolute residual. A significant lag-one correlation rho of the residuals raises the variances by (1 + rho)/(1 - rho).
/// @param points  in order of x, two or more with different x
[[nodiscard]] RobustLine fit_line(const std::vector<LinePoint>& points, double reference, Sigmas sigmas);

/// The biweight of standardised residuals, and their scale; both are also used for other linear models.
[[nodiscard]] double robust_scale(std::vector<double> standardised, double parameters);
[[nodiscard]] double biweight(double standardised);

}  // namespace coast::array
