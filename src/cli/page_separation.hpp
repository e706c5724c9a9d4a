#pragma once
// Forward minus backward filter, summed up: the figures of the acceptance sheet and of its section.

#include <optional>
#include <vector>

#include "process_result.hpp"

namespace coast::cli {

/// Over the knots where both filters have settled: the combined sigma is below three times its median. At the ends of a
/// mission and inside outages one of the two has hardly seen a fix, and the separation says nothing of the smoothed result.
struct SeparationSummary {
  std::size_t epochs = 0;
  double settled = 0.0;  ///< share of the knots that entered
  double horizontal_rms_m = 0.0;
  double horizontal_95_m = 0.0;
  double vertical_rms_m = 0.0;
  double vertical_95_m = 0.0;
  Eigen::Vector3d attitude_rms = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw, rad
  Eigen::Vector3d attitude_95 = Eigen::Vector3d::Zero();
  double position_over_sigma = 0.0;  ///< rms of the separation over its sigma, all components; 1 is consistent
  double attitude_over_sigma = 0.0;
};

/// @return nothing where there is no knot with both filters
[[nodiscard]] std::optional<SeparationSummary> summarise(const std::vector<Separation>& separations);

}  // namespace coast::cli
