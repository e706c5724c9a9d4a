#pragma once
// Summary of forward minus backward filter: for the acceptance sheet and its section.

#include <optional>
#include <vector>

#include "coast/jobs/process.hpp"

namespace coast::jobs {

/// Over the knots where both filters have converged: the combined sigma is below three times its median. At the ends of a
/// mission and inside outages one of the two has used hardly any fix, and the separation does not describe the smoothed result.
struct SeparationSummary {
  std::size_t epochs = 0;
  double settled = 0.0;  ///< fraction of the knots used
  double horizontal_rms_m = 0.0;
  double horizontal_95_m = 0.0;
  double vertical_rms_m = 0.0;
  double vertical_95_m = 0.0;
  Eigen::Vector3d attitude_rms = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw, rad
  Eigen::Vector3d attitude_95 = Eigen::Vector3d::Zero();
  double position_over_sigma = 0.0;  ///< rms of the separation over its sigma, all components; 1 is consistent
  double attitude_over_sigma = 0.0;
};

/// @return none if no knot has both filters
[[nodiscard]] std::optional<SeparationSummary> summarise(const std::vector<Separation>& separations);

}  // namespace coast::jobs
