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

/// States at the knots of a sampling: some ten thousand over a mission of any length.
class KnotStates {
 public:
  explicit KnotStates(double mission_s);
  void add(const estimate::FilterState& state);
  [[nodiscard]] const estimate::KnotSampling& sampling() const { return sampling_; }
  [[nodiscard]] const std::vector<KnotState>& knots() const { return knots_; }

 private:
  estimate::KnotSampling sampling_;
  std::optional<geo::GpsTime> previous_;
  std::vector<KnotState> knots_;
};

/// Sensor and auxiliary states over time. @param smoothed with states at the sampled knots, or empty
[[nodiscard]] std::vector<StateTrack> state_tracks(const estimate::StateLayout& layout, geo::GpsTime start,
                                                   const std::vector<KnotState>& forward,
                                                   const std::vector<estimate::SmoothedKnot>& smoothed);

/// Says of an offset of all GNSS positions that nothing in the mission shows it.
/// @return  nothing where there is none, or it is seen
[[nodiscard]] std::optional<record::Event> unseen_base_offset(const std::vector<StateTrack>& states);

/// Forward minus backward filter at the sampled knots of the forward one, while the backward one runs from the far end.
class SeparationRecorder {
 public:
  explicit SeparationRecorder(const std::vector<KnotState>& forward) : forward_(forward), left_(forward.size()) {}
  void add(const estimate::FilterState& backward);
  [[nodiscard]] std::vector<Separation> in_order() &&;

 private:
  const std::vector<KnotState>& forward_;
  std::size_t left_;  ///< knots of the forward filter that the backward one has not passed yet
  std::vector<Separation> separations_;
};

}  // namespace coast::cli
