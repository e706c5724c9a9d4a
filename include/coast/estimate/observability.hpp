#pragma once
// What a mission shows of the states that are one for all of it: lever arm, time offset, mounting, base offset, constants.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "coast/estimate/filter_state.hpp"

namespace coast::estimate {

/// How far the measurements have shown an unknown.
enum class Observability {
  kSeen,        ///< sd at most half of the prior's: the measurements say three times as much as the prior, or more
  kWeaklySeen,  ///< at most 0.9 of it
  kNotSeen,     ///< above: what is reported is the prior
  kTogether,    ///< seen or weakly, but |correlation| with another unknown above 0.98: it is their sum that is seen
};
inline constexpr double kSeenRatio = 0.5;
inline constexpr double kWeaklySeenRatio = 0.9;
inline constexpr double kTogetherCorrelation = 0.98;
/// "seen", "weakly seen", "not seen", "seen together".
[[nodiscard]] std::string_view name(Observability observability);

/// One component of an unknown of the whole mission, SI units.
struct MissionUnknown {
  std::string name;  ///< "lever_arm forward", "gyro_x scale_factor"; a base offset is resolved in N, E, D
  double estimate = 0.0;
  double prior_sd = 0.0;
  double posterior_sd = 0.0;
  std::string with;          ///< the state that its error is most correlated with, at the knot looked at
  double correlation = 0.0;  ///< with that, -1 to 1
  [[nodiscard]] double ratio() const { return posterior_sd / prior_sd; }
  [[nodiscard]] Observability observability() const;
};

/// A name for every state of the layout. Vectors in e are named by N, E, D, in which resolved_in_n() has them.
[[nodiscard]] std::vector<std::string> state_names(const StateLayout& layout);

/// What is known of states of the mission at one instant, against what was known before.
/// @param which  indices of states, each with a variance above zero in `prior`
/// @param prior  n x n, at the start
/// @param state  estimate, and covariance behind all measurements
[[nodiscard]] std::vector<MissionUnknown> mission_unknowns(const StateLayout& layout, const std::vector<int>& which,
                                                           const Eigen::MatrixXd& prior, const FilterState& state);

}  // namespace coast::estimate
