#pragma once
// Filter states stored at knots: for the sensor-error panels and the separation.

#include <utility>
#include <vector>

#include "coast/jobs/process.hpp"

namespace coast::jobs {

/// State at one knot without the off-diagonal covariances.
struct KnotState {
  record::NavState nav;
  record::NavCovariance cov;
  Eigen::VectorXd x;
  Eigen::VectorXd sd;
};
[[nodiscard]] KnotState knot_state(const estimate::FilterState& state);

/// Some ten thousand knots over a mission of any length.
[[nodiscard]] estimate::KnotSampling knot_sampling(double mission_s);

/// States at the knots of a sampling.
class KnotStates {
 public:
  explicit KnotStates(const estimate::KnotSampling& sampling) : sampling_(sampling) {}
  void add(const estimate::FilterState& state);
  [[nodiscard]] std::vector<KnotState> knots() && { return std::move(knots_); }

 private:
  estimate::KnotSampling sampling_;
  std::optional<geo::GpsTime> previous_;
  std::vector<KnotState> knots_;
};

/// Sensor and auxiliary states over time. @param smoothed with states at the sampled knots, or empty
[[nodiscard]] std::vector<StateTrack> state_tracks(const estimate::StateLayout& layout, geo::GpsTime start,
                                                   const std::vector<KnotState>& forward,
                                                   const std::vector<estimate::SmoothedKnot>& smoothed);

/// Reports an offset of all GNSS positions that is not observable in the mission.
/// @return  none if there is no offset, or it is observable
[[nodiscard]] std::optional<record::Event> unseen_base_offset(const std::vector<StateTrack>& states);

/// Forward minus backward filter at the sampled knots of the forward one, while the backward one runs from the end.
class SeparationRecorder {
 public:
  explicit SeparationRecorder(const std::vector<KnotState>& forward) : forward_(forward), left_(forward.size()) {}
  void add(const estimate::FilterState& backward);
  [[nodiscard]] std::vector<Separation> in_order() &&;

 private:
  const std::vector<KnotState>& forward_;
  std::size_t left_;  ///< knots of the forward filter that the backward one has not reached yet
  std::vector<Separation> separations_;
};

}  // namespace coast::jobs
