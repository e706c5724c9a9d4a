#pragma once
// The filter's error for unit errors of constants that it takes as known; private to the room.

#include <vector>

#include "coast/estimate/constant_scores.hpp"

namespace coast::estimate {

class ConstantRecursion {
 public:
  /// @param X  the error at the start, n x p
  ConstantRecursion(const StateLayout& layout, Eigen::MatrixXd X) : layout_(layout), blocks_(layout), X_(std::move(X)) {}

  /// @param D  of each update: what the constants do to the measurement itself, m x p; empty: nothing
  [[nodiscard]] ConstantScore through_updates(const Knot& knot, const std::vector<Eigen::MatrixXd>& D = {}) {
    const Eigen::Index p = X_.cols();
    ConstantScore here{knot.post.nav.t, Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p)};
    for (std::size_t i = 0; i < knot.updates.size(); ++i) {
      const AppliedUpdate& u = knot.updates[i];
      Eigen::MatrixXd V = u.H * X_;
      if (!D.empty()) V += D[i];
      const Eigen::MatrixXd weighted = u.S_inv * V;
      here.score.noalias() += weighted.transpose() * u.y;
      here.information.noalias() += V.transpose() * weighted;
      X_.noalias() -= u.K * V;
    }
    return here;
  }

  /// @param W  what the constants do to the navigation states in the interval, 9 x p
  void through_transition(const Knot& knot, const NavRows& W) {
    const Eigen::MatrixXd nav = knot.Phi_n * X_.topRows(knot.Phi_n.cols()) + W;
    blocks_.over(knot.interval, knot.renews_gnss_error).apply(X_.bottomRows(layout_.size() - kNav));
    X_.topRows<kNav>() = nav;
  }

 private:
  const StateLayout& layout_;
  BlockTransitions blocks_;
  Eigen::MatrixXd X_;
};

}  // namespace coast::estimate
