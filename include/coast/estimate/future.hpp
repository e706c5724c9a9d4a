#pragma once
// Information from all measurements after a knot, in a form that another run of the filter can use.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "coast/estimate/knot.hpp"
#include "coast/estimate/state_layout.hpp"

namespace coast::estimate {

/// Likelihood of all measurements after a knot's updates as a function of the state there, independent of earlier measurements:
/// a quadratic in d = nominal - truth with the smoother's transitions,
///
///     -2 log p = d' L d - 2 l' d + constant
///
/// With P of any filter at the same instant, r = (I + L P)^-1 l and N = (I + L P)^-1 L continue its smoother as if it had
/// processed these measurements itself (Fraser & Potter 1969, two filters; here only the information of the backward filter is
/// stored).
struct Future {
  record::NavState nav;         ///< nominal state at which the likelihood is expanded
  Eigen::VectorXd x;            ///< likewise, sensor and auxiliary states
  Eigen::MatrixXd information;  ///< L, n x n, symmetric
  Eigen::VectorXd vector;       ///< l, n
};

/// The futures of some knots by one backward pass over all.
/// @param at  indices of knots, ascending; repeated ones are allowed
[[nodiscard]] std::vector<Future> futures(const KnotStore& knots, const StateLayout& layout, std::span<const std::size_t> at);

}  // namespace coast::estimate
