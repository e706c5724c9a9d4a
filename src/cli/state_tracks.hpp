#pragma once
// What is kept of the filter's states at knots: for the sensor-error panels and the separation.

#include <vector>

#include "process_result.hpp"

namespace coast::cli {

/// State at one knot without the off-diagonal covariances.
struct KnotState {
  record::NavState nav;
  record::NavCovariance cov;
  Eigen::VectorXd x;
  Eigen::VectorXd sd;
};
[[nodiscard]] KnotState knot_state(const estimate::FilterState& state);

/// Sensor and auxiliary states over time. @param smoothed one per knot, or empty
[[nodiscard]] std::vector<StateTrack> state_tracks(const estimate::StateLayout& layout, geo::GpsTime start,
                                                   const std::vector<KnotState>& forward,
                                                   const std::vector<estimate::SmoothedKnot>& smoothed);
/// Forward minus backward at the knots that both have; both in order of time.
[[nodiscard]] std::vector<Separation> separations(const std::vector<KnotState>& forward,
                                                  const std::vector<KnotState>& backward);

}  // namespace coast::cli
