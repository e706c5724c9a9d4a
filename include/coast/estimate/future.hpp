#pragma once
// What lies behind a knot, said so that another run of the filter can use it.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "coast/estimate/knot.hpp"
#include "coast/estimate/state_layout.hpp"

namespace coast::estimate {

/// What all measurements behind a knot's updates say about the state there, whatever was filtered before: their likelihood, a
/// quadratic in d = nominal - truth with the smoother's transitions,
///
///     -2 log p = d' L d - 2 l' d + constant
///
/// With P of any filter that arrives at the same instant, r = (I + L P)^-1 l and N = (I + L P)^-1 L continue its smoother as if
/// it had filtered them itself (Fraser & Potter 1969, two filters; here only the backward one's information is kept).
struct Future {
  record::NavState nav;         ///< the nominal state it is about
  Eigen::VectorXd x;            ///< likewise, sensor and auxiliary states
  Eigen::MatrixXd information;  ///< L, n x n, symmetric
  Eigen::VectorXd vector;       ///< l, n
};

/// The futures of some knots by one backward pass over all.
/// @param at  indices of knots, ascending; repeated ones are allowed
[[nodiscard]] std::vector<Future> futures(const KnotStore& knots, const StateLayout& layout, std::span<const std::size_t> at);

}  // namespace coast::estimate
