#pragma once
// Which states are unknowns at every knot, and which are one unknown for the mission; private to the room.

#include <Eigen/Core>
#include <vector>

#include "coast/estimate/filter_state.hpp"

namespace coast::estimate {

/// States with driving noise have a value at every knot. States without it follow from their value at the start by their
/// process: as unknowns at every knot they would be coupled by noise-free equations with infinite weight.
///
/// With a base offset b the unknown at a knot is not the position r but r + b, which is measured by fixes: r and b separately
/// are determined only by the prior, and normal equations in them have a condition number a thousand times larger.
class BatchUnknowns {
 public:
  /// @param start  states with zero covariance and no driving noise are not unknowns
  BatchUnknowns(const StateLayout& layout, const FilterState& start);

  [[nodiscard]] const std::vector<int>& at_knots() const { return at_knots_; }  ///< navigation states first
  [[nodiscard]] const std::vector<int>& once() const { return once_; }
  [[nodiscard]] const std::vector<int>& unknown_once() const { return unknown_once_; }  ///< among them, at the start

  /// Effect of the mission's unknowns on the errors of all states `elapsed` after the start, in addition to those of the knot:
  /// n x unknown_once(). Valid until the next call.
  [[nodiscard]] const Eigen::MatrixXd& of_mission(double elapsed);
  /// once() `elapsed` after the start, propagated from the start's values.
  [[nodiscard]] Eigen::VectorXd prior_mean(double elapsed);

 private:
  BlockTransitions blocks_;
  Eigen::VectorXd start_;  ///< sensor and auxiliary states
  std::vector<int> at_knots_, once_, unknown_once_;
  double elapsed_ = 0.0;
  Eigen::MatrixXd of_mission_, at_start_;
  bool constant_ = false;  ///< all of once() are constant
};

}  // namespace coast::estimate
