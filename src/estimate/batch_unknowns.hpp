#pragma once
// Which states are unknowns at every knot, and which are one for the mission; private to the room.

#include <Eigen/Core>
#include <vector>

#include "coast/estimate/filter_state.hpp"

namespace coast::estimate {

/// States with driving noise have a value at every knot. One without moves as its process says from what it was at the start:
/// as unknowns at every knot they would be tied by equations without noise, which no weight can state.
///
/// With a base offset b the unknown at a knot is not the position r but r + b, which is what fixes measure: r and b themselves
/// differ by what nothing but the prior knows, and normal equations in them are a thousand times as ill-conditioned.
class BatchUnknowns {
 public:
  /// @param start  what its covariance says is known, and has no driving noise, is no unknown
  BatchUnknowns(const StateLayout& layout, const FilterState& start);

  [[nodiscard]] const std::vector<int>& at_knots() const { return at_knots_; }  ///< navigation states first
  [[nodiscard]] const std::vector<int>& once() const { return once_; }
  [[nodiscard]] const std::vector<int>& unknown_once() const { return unknown_once_; }  ///< among them, at the start

  /// What the unknowns of the mission are to the errors of all states `elapsed` after the start, beside those of the knot:
  /// n x unknown_once(). Until the next call.
  [[nodiscard]] const Eigen::MatrixXd& of_mission(double elapsed);
  /// once() `elapsed` after the start as it would be with the start's values.
  [[nodiscard]] Eigen::VectorXd prior_mean(double elapsed);

 private:
  BlockTransitions blocks_;
  Eigen::VectorXd start_;  ///< sensor and auxiliary states
  std::vector<int> at_knots_, once_, unknown_once_;
  double elapsed_ = 0.0;
  Eigen::MatrixXd of_mission_, at_start_;
  bool constant_ = false;  ///< none of once() moves
};

}  // namespace coast::estimate
