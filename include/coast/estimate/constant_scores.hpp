#pragma once
// What each measurement says of constants, so that their standard deviations can be compared with how much parts of a mission
// differ in what they say.

#include <Eigen/Core>
#include <vector>

#include "coast/estimate/knot.hpp"
#include "coast/estimate/state_layout.hpp"

namespace coast::estimate {

/// Score and information of constants in the updates of one knot. With the error c (estimate - truth) of constants that the
/// filter takes as known, its innovations are -nu = V c + white noise of covariance S, and
///
///     score = -V' S^-1 nu,   information = V' S^-1 V:
///
/// (sum of information)^-1 (sum of scores) estimates c as a filter does in which they are states without prior.
struct ConstantScore {
  geo::GpsTime t;
  Eigen::VectorXd score;        ///< p
  Eigen::MatrixXd information;  ///< p x p
};

/// V is H times the filter's error for unit c, one column per constant: X <- (I - K H) X at an update, X <- Phi X between
/// knots.
///
/// @param knots   of a forward pass that begins with zero covariance of `states`; without carrier slots
/// @param states  indices of constant states
/// @return        one for each knot with updates, in order of time
[[nodiscard]] std::vector<ConstantScore> constant_scores(const StateLayout& layout, const KnotStore& knots,
                                                         const std::vector<int>& states);

/// How much the estimates of parts of a mission differ, against their standard deviations.
struct BlockScatter {
  Eigen::VectorXd factor;   ///< on the standard deviations of the filter, >= 1
  Eigen::VectorXd ratio;    ///< variance between blocks over its expectation under the filter's model
  Eigen::VectorXd freedom;  ///< degrees of freedom of that variance
};

/// Errors that the filter takes for white but last for seconds to minutes leave its estimates of constants nearly unbiased and
/// make their standard deviations too small. The scores of blocks that are long against such errors are independent all the
/// same, and their scatter gives the covariance that the estimates have (White 1980; of blocks: Liang & Zeger 1986),
///
///     C (sum over blocks of e e') C,   e = score - information c^,   C = (sum of information + prior)^-1,
///
/// where the model predicts C (information - information C information) C of each block. Where the scatter is larger than it is
/// by chance in 5 % of missions whose model is right, its root is the factor, and with it the quantile of Student's
/// distribution for its degrees of freedom, so that 1.96 standard deviations are 95 %. Otherwise the factor is 1.
///
/// Blocks are of 30 s, in missions longer than 20 min a fortieth of them; a scatter with fewer than 5 degrees of freedom
/// (effective ones: Satterthwaite 1946) decides nothing. An error that lasts for the whole mission leaves no trace in it.
/// @param prior  information of the prior, of independent constants; p
[[nodiscard]] BlockScatter block_scatter(const std::vector<ConstantScore>& scores, const Eigen::VectorXd& prior);

}  // namespace coast::estimate
