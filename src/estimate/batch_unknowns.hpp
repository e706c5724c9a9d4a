#pragma once
// Which states are unknowns at every knot, and which are one for the mission; private to the room.

#include <Eigen/Core>
#include <vector>

#include "coast/estimate/state_layout.hpp"

namespace coast::estimate {

/// States with driving noise have a value at every knot. One without moves as its process says from what it was at the start:
/// as unknowns at every knot they would be tied by equations without noise, which no weight can state.
class BatchUnknowns {
 public:
  /// @param P  covariance of the start: what it says is known, and has no driving noise, is no unknown
  BatchUnknowns(const StateLayout& layout, const Eigen::MatrixXd& P);

  [[nodiscard]] const std::vector<int>& at_knots() const { return at_knots_; }  ///< navigation states first
  [[nodiscard]] const std::vector<int>& once() const { return once_; }
  [[nodiscard]] const std::vector<int>& unknown_once() const { return unknown_once_; }  ///< among them, at the start

  /// The states of the second kind `elapsed` after the start, from what is unknown of them there: once() x unknown_once().
  [[nodiscard]] Eigen::MatrixXd moved(double elapsed);

 private:
  const StateLayout& layout_;
  BlockTransitions blocks_;
  std::vector<int> at_knots_, once_, unknown_once_;
  bool constant_ = true;  ///< all of the second kind
};

}  // namespace coast::estimate
