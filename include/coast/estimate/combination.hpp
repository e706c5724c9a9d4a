#pragma once
// Combination of forward and backward filter, state by state: weighted mean if they agree, one of the two if not.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "coast/estimate/knot.hpp"
#include "coast/estimate/smoother.hpp"
#include "coast/record/event.hpp"

namespace coast::estimate {

/// Normalised distance of two states at one instant, d' (P_f + P_b)^-1 d over the nine navigation states: chi-square with 9
/// degrees of freedom if their errors are independent, smaller or larger if they are correlated.
/// @param forward, backward  P at least 9 x 9, e frame, navigation states first
/// @throws NumericalError  P_f + P_b is not positive definite
[[nodiscard]] double contradiction(const FilterState& forward, const FilterState& backward);

/// Two states at one instant, weighted by their information,
///
///     d = error of forward relative to backward,   W = P_f (P_f + P_b)^-1,   P = (I - W) P_f (I - W)' + W P_b W'
///
/// and W d is subtracted from the forward state. P is (P_f^-1 + P_b^-1)^-1 without an inverse of either. Both filters used the
/// prior of the states after the ninth (zero, with a variance each); it is then removed once: exact if that variance does not
/// change with time.
/// @param forward, backward  x of m >= 9 elements, P m x m, e frame, navigation states first
/// @param prior_variance     m - 9 values; zero: a state known to both
/// @throws NumericalError  P_f + P_b is not positive definite
/// @see  Fraser, Potter (1969): The optimum linear smoother as a combination of two optimum linear filters, IEEE Trans. AC
/// 14(4)
[[nodiscard]] FilterState weighted_mean(const FilterState& forward, const FilterState& backward,
                                        const Eigen::VectorXd& prior_variance);

/// The backward filter at the knots of a forward one, before the updates there. Navigation and auxiliary states with their
/// covariance are in a KnotStore, so that memory does not grow with the mission; sensor states at sampled knots are in memory.
class BackwardKnots {
 public:
  /// @param at      times of the forward filter's knots, ascending
  /// @param begin   start state of the backward filter, in forward time: its variances are the prior of both filters
  /// @param states  knots for which sensor states are stored
  BackwardKnots(const StateLayout& layout, std::vector<geo::GpsTime> at, const FilterState& begin,
                const KnotSampling& states = KnotSampling{});
  /// Adds a state in forward time, in order from the last to the first. States that are not at a knot are ignored.
  void add(const FilterState& state);

  struct Sensors {
    Eigen::VectorXd x;         ///< size of the layout
    Eigen::VectorXd variance;  ///< likewise
  };
  [[nodiscard]] std::size_t size() const { return at_.size(); }
  /// Navigation and auxiliary states; nothing if the backward filter did not reach this knot.
  [[nodiscard]] std::optional<FilterState> at(std::size_t knot) const;
  /// Null if they are not stored.
  [[nodiscard]] const Sensors* sensors(std::size_t knot) const;
  [[nodiscard]] bool keeps_sensors(std::size_t knot) const;
  /// Prior variance of both filters, size of the layout.
  [[nodiscard]] const Eigen::VectorXd& prior_variance() const { return prior_variance_; }

 private:
  std::vector<geo::GpsTime> at_;
  KnotSampling sampling_;
  Eigen::Index first_auxiliary_;
  Eigen::Index auxiliaries_;
  Eigen::VectorXd prior_variance_;
  std::size_t left_;  ///< knots that the backward filter has not passed
  KnotStore store_;
  std::vector<std::optional<std::size_t>> place_;  ///< index of a knot in the store
  std::map<std::size_t, Sensors> sensors_;
};

struct Combination {
  std::vector<SmoothedKnot> knots;
  record::Events events;  ///< `combination_refused`: no weighted mean was formed
};

/// The combined solution: at every knot the forward filter after its updates with the backward filter before them, so that no
/// measurement is used twice.
///
/// If their contradiction() exceeds the value that consistent filters exceed at one knot in 1e6, no mean is formed: the
/// solution with the smaller trace of the position covariance is used with its own covariance, and the result jumps there
/// (SmoothedKnot::jumps). It is kept until the other has less than half its trace, and averaging resumes only when the
/// contradiction is below the value exceeded at one knot in a thousand; this hysteresis avoids repeated jumps.
///
/// Not the fixed-interval smoother (smooth()). Navigation and auxiliary states are weighted together by their full covariances,
/// sensor errors individually: their correlation with the navigation states is lost, and information that both filters take
/// from the error model rather than from measurements counts twice. A bias that neither filter has estimated moves both
/// positions the same way, so the position sigma is too small, by at most sqrt(2), and both velocities in opposite directions,
/// so the velocity sigma is too large. Without sensor states the result equals the smoother except at the ends. In simulated
/// outages of 30 s, from tactical to consumer sensors, position sigmas were correct, velocity sigmas were up to a quarter too
/// large, and errors were 1 to 20 % larger than those of the smoother (docs/solutions.md).
/// @param forward  knots of a forward pass; carrier slots are those of this pass
[[nodiscard]] Combination combine(const KnotStore& forward, const BackwardKnots& backward, const StateLayout& layout,
                                  const std::function<void(double)>& progress = {});

}  // namespace coast::estimate
