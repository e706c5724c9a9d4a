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
  std::vector<estimate::SmoothedKnot> smoothed;  ///< empty without a smoother
  std::optional<estimate::BatchReport> batch;    ///< if the batch smoother was used
};

struct SolutionOutputs {
  record::EpochSink forward;
  record::EpochSink smoothed;
  std::function<void(const estimate::FilterState&)> at_knots;
  /// Every measurement of the forward pass, and whether it was used; not for carrier phases.
  std::function<void(const estimate::Measurement&, bool)> measurements;
  estimate::KnotSampling states;  ///< smoothed knots for which sensor states are stored
};
/// The backward filter of a combined solution: a forward pass gives the times of the knots and the final state, then the
/// backward filter computes its states at the same knots. The recordings are temporarily reversed.
/// @param states  knots for which sensor states are stored
[[nodiscard]] estimate::BackwardKnots backward_knots(PreparedMission& mission, const estimate::FilterOptions& options,
                                                     const estimate::KnotSampling& states, const Progress& progress);

/// @param carried  start from earlier passes, with their covariance (carried_start). The forward solution begins with it; the
///                 smoothed one uses only its states, with the uncertainty of the alignment, so that no fix counts twice in its
///                 sigmas: this needs another forward pass.
/// @param backward  backward_knots() of the same options: the smoothed solution is the combined one. Null: smoother of the
///                  setup. Not with `carried`, because both filters would then have used the same fixes.
[[nodiscard]] Solution solve(const PreparedMission& mission, const estimate::FilterOptions& options, bool smooth,
                             const SolutionOutputs& outputs, const Progress& progress,
                             const std::optional<estimate::FilterState>& carried = {},
                             const estimate::BackwardKnots* backward = nullptr);

/// Multi-pass: forward, backward, ... over the whole mission, each pass begins with the final states and covariance of the
/// previous one, until the start is reached again.
///
/// Advantage: the forward filter has converged when the mission begins, and is linearised about a start estimated from the
/// whole mission. Disadvantage: the covariance counts every fix once for each pass.
/// @param passes  odd, 3 or more; the last, forward pass is done by solve()
[[nodiscard]] estimate::FilterState carried_start(PreparedMission& mission, const estimate::FilterOptions& options, int passes,
                                                  const Progress& progress);

/// Lever arm estimated from the data, with the configured one as prior mean.
struct LeverArmCheck {
  Eigen::Vector3d difference_m;  ///< estimated minus configured, body axes
  Eigen::Vector3d sd_m;
};
[[nodiscard]] LeverArmCheck check_lever_arm(const PreparedMission& mission, double prior_sd_m, const Progress& progress);

}  // namespace coast::study
