#pragma once
// Observability of the states that are constant over a mission: lever arm, time offset, mounting, base offset, constants.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "coast/estimate/filter_state.hpp"

namespace coast::estimate {

/// How well the measurements determine an unknown.
enum class Observability {
  kSeen,        ///< sd at most half of the prior's: the measurements give at least three times the information of the prior
  kWeaklySeen,  ///< sd at most 0.9 of the prior's
  kNotSeen,     ///< sd larger: the reported value is essentially the prior
  kTogether,    ///< seen or weakly seen, but |correlation| with another unknown above 0.98: only their sum is determined
};
inline constexpr double kSeenRatio = 0.5;
inline constexpr double kWeaklySeenRatio = 0.9;
inline constexpr double kTogetherCorrelation = 0.98;
/// "seen", "weakly seen", "not seen", "seen together".
[[nodiscard]] std::string_view name(Observability observability);

/// One component of an unknown that is constant over the mission, SI units.
struct MissionUnknown {
  std::string name;  ///< "lever_arm forward", "gyro_x scale_factor"; a base offset is resolved in N, E, D
  double estimate = 0.0;
  double prior_sd = 0.0;
  double posterior_sd = 0.0;
  std::string with;          ///< the state whose error is most correlated with its own, at the evaluated knot
  double correlation = 0.0;  ///< with that state, -1 to 1
  [[nodiscard]] double ratio() const { return posterior_sd / prior_sd; }
  [[nodiscard]] Observability observability() const;
};

/// A name for every state of the layout. Vectors in e are named by N, E, D, as resolved by resolved_in_n().
[[nodiscard]] std::vector<std::string> state_names(const StateLayout& layout);

/// Posterior of constant states at one instant, compared with the prior.
/// @param which  indices of states, each with a variance above zero in `prior`
/// @param prior  n x n, at the start
/// @param state  estimate, and covariance after all measurements
[[nodiscard]] std::vector<MissionUnknown> mission_unknowns(const StateLayout& layout, const std::vector<int>& which,
                                                           const Eigen::MatrixXd& prior, const FilterState& state);

}  // namespace coast::estimate
