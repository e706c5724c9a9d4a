#pragma once
// Forward and backward filter, one state at a time: weighted where they agree, one of the two where they do not.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "coast/estimate/knot.hpp"
#include "coast/estimate/smoother.hpp"
#include "coast/record/event.hpp"

namespace coast::estimate {

/// How far two states at one instant lie apart, d' (P_f + P_b)^-1 d over the nine navigation states: chi-square of 9 where
/// their errors are independent, less or more where they share some.
/// @param forward, backward  P at least 9 x 9, e frame, navigation states first
/// @throws NumericalError  P_f + P_b is not positive definite
[[nodiscard]] double contradiction(const FilterState& forward, const FilterState& backward);

/// Two states at one instant, weighted by their information,
///
///     d = error of forward against backward,   W = P_f (P_f + P_b)^-1,   P = (I - W) P_f (I - W)' + W P_b W'
///
/// and W d taken off the forward state. P is (P_f^-1 + P_b^-1)^-1 without an inverse of either. What both filters knew
/// beforehand of the states beyond the ninth (zero, with a variance each) is then taken out once: exact where that variance
/// does not change with time.
/// @param forward, backward  x of m >= 9 elements, P m x m, e frame, navigation states first
/// @param prior_variance     m - 9 values; zero: a state that both know
/// @throws NumericalError  P_f + P_b is not positive definite
/// @see  Fraser, Potter (1969): The optimum linear smoother as a combination of two optimum linear filters, IEEE Trans. AC
/// 14(4)
[[nodiscard]] FilterState weighted_mean(const FilterState& forward, const FilterState& backward,
                                        const Eigen::VectorXd& prior_variance);

/// The backward filter at the knots of a forward one, before the updates there. Navigation and auxiliary states with their
/// covariance stand in a KnotStore, so that memory does not grow with the mission; sensor states at sampled knots in memory.
class BackwardKnots {
 public:
  /// @param at      times of the forward filter's knots, ascending
  /// @param begin   what the backward filter begins with, in forward time: its variances are what both know beforehand
  /// @param states  knots that keep sensor states
  BackwardKnots(const StateLayout& layout, std::vector<geo::GpsTime> at, const FilterState& begin,
                const KnotSampling& states = KnotSampling{});
  /// A state in forward time; they come from the last to the first. What stands at no knot is passed over.
  void add(const FilterState& state);

  struct Sensors {
    Eigen::VectorXd x;         ///< size of the layout
    Eigen::VectorXd variance;  ///< likewise
  };
  [[nodiscard]] std::size_t size() const { return at_.size(); }
  /// Navigation and auxiliary states; nothing where the backward filter has not been.
  [[nodiscard]] std::optional<FilterState> at(std::size_t knot) const;
  /// Null where they are not kept.
  [[nodiscard]] const Sensors* sensors(std::size_t knot) const;
  [[nodiscard]] bool keeps_sensors(std::size_t knot) const;
  /// What both filters know beforehand, size of the layout.
  [[nodiscard]] const Eigen::VectorXd& prior_variance() const { return prior_variance_; }

 private:
  std::vector<geo::GpsTime> at_;
  KnotSampling sampling_;
  Eigen::Index first_auxiliary_;
  Eigen::Index auxiliaries_;
  Eigen::VectorXd prior_variance_;
  std::size_t left_;  ///< knots that the backward filter has not passed
  KnotStore store_;
  std::vector<std::optional<std::size_t>> place_;  ///< of a knot in the store
  std::map<std::size_t, Sensors> sensors_;
};

struct Combination {
  std::vector<SmoothedKnot> knots;
  record::Events events;  ///< `combination_refused`: where nothing was averaged
};

/// The combined solution: at every knot the forward filter after its updates and the backward filter before them, which have no
/// measurement in common.
///
/// Where their contradiction() is beyond what one knot in 1e6 of consistent filters reaches, nothing is averaged: the one with
/// the smaller trace of its position covariance is delivered with its own covariance, and the solution jumps there
/// (SmoothedKnot::jumps). It stays that one until the other has less than half its trace, and nothing is averaged again before
/// the contradiction is less than one knot in a thousand has, so that it does not jump to and fro at a bound.
///
/// Not the fixed-interval smoother (smooth()). Navigation and auxiliary states are weighted together by their full covariances,
/// sensor errors each by itself: what they have in common with the navigation states is lost, and what both filters take from
/// the error model rather than from measurements counts twice. A bias that neither has learned moves both positions the same
/// way, whose sigma is then too small, by sqrt(2) at the utmost, and both velocities oppositely, whose sigma is too large.
/// Without sensor states it is the smoother but for the ends. In simulated outages of 30 s, from tactical to consumer sensors,
/// position sigmas held, those of velocity were up to a quarter too large, and errors 1 to 20 % larger than the smoother's
/// (docs/solutions.md).
/// @param forward  knots of a forward pass; carrier slots are as there
[[nodiscard]] Combination combine(const KnotStore& forward, const BackwardKnots& backward, const StateLayout& layout,
                                  const std::function<void(double)>& progress = {});

}  // namespace coast::estimate
