#pragma once
// The solution of a prepared mission: forward, smoothed, combined, in several passes.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "coast/estimate/combination.hpp"
#include "coast/estimate/smoother.hpp"
#include "coast/study/mission.hpp"

namespace coast::study {

/// Forward and smoothed solution of one mission.
struct Solution {
  std::unique_ptr<estimate::ForwardFilter> filter;
  estimate::FilterResult forward;
  estimate::KnotStore knots;
  std::vector<estimate::SmoothedKnot> smoothed;  ///< empty without smoother
  std::optional<estimate::BatchReport> batch;    ///< where the batch made them
};

struct SolutionOutputs {
  record::EpochSink forward;
  record::EpochSink smoothed;
  std::function<void(const estimate::FilterState&)> at_knots;
  /// Every measurement of the forward pass, and whether it was used; none of carrier phases.
  std::function<void(const estimate::Measurement&, bool)> measurements;
  estimate::KnotSampling states;  ///< smoothed knots that keep their sensor states
};
/// The backward filter's half of a combined solution: a forward pass says where knots are and how it ends, then the backward
/// filter makes its knots there too. The recordings are turned round for a while.
/// @param states  knots that keep sensor states
[[nodiscard]] estimate::BackwardKnots backward_knots(PreparedMission& mission, const estimate::FilterOptions& options,
                                                     const estimate::KnotSampling& states, const Progress& progress);

/// @param carried  start that earlier passes left, with their covariance (carried_start). The forward solution begins with it;
///                 the smoothed one takes its states alone and the uncertainty of the alignment, so that no fix counts twice in
///                 its sigmas: it costs another forward pass.
/// @param backward  backward_knots() of the same options: the smoothed solution is the combined one. Null: by the setup. Not
///                  with `carried`, after which both filters would know the same fixes.
[[nodiscard]] Solution solve(const PreparedMission& mission, const estimate::FilterOptions& options, bool smooth,
                             const SolutionOutputs& outputs, const Progress& progress,
                             const std::optional<estimate::FilterState>& carried = {},
                             const estimate::BackwardKnots* backward = nullptr);

/// Multi-pass: forward, backward, ... over the whole mission, each pass beginning with the states and the covariance that the
/// one before ended with, until one arrives at the start again.
///
/// What it gives: a forward filter that has converged when the mission begins, and a linearisation about a start that the whole
/// mission knows. What it costs: the covariance carried counts every fix once for each pass.
/// @param passes  odd, 3 or more; the last, forward one is left to solve()
[[nodiscard]] estimate::FilterState carried_start(PreparedMission& mission, const estimate::FilterOptions& options, int passes,
                                                  const Progress& progress);

/// Lever arm found by the data when it is left free around the configured one.
struct LeverArmCheck {
  Eigen::Vector3d difference_m;  ///< estimated minus configured, body axes
  Eigen::Vector3d sd_m;
};
[[nodiscard]] LeverArmCheck check_lever_arm(const PreparedMission& mission, double prior_sd_m, const Progress& progress);

}  // namespace coast::study
