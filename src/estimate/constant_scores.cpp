#include "coast/estimate/constant_scores.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/noise/chi_square.hpp"
#include "constant_recursion.hpp"

namespace coast::estimate {

std::vector<ConstantScore> constant_scores(const StateLayout& layout, const KnotStore& knots, const std::vector<int>& states) {
  const auto p = static_cast<Eigen::Index>(states.size());
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(layout.size(), p);
  for (Eigen::Index i = 0; i < p; ++i) X(states[static_cast<std::size_t>(i)], i) = 1.0;
  const NavRows nothing = NavRows::Zero(kNav, p);
  ConstantRecursion recursion(layout, std::move(X));
  std::vector<ConstantScore> scores;
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const Knot knot = knots.at(k);
    if (!knot.updates.empty()) scores.push_back(recursion.through_updates(knot));
    if (k + 1 < knots.size()) recursion.through_transition(knot, nothing);
  }
  return scores;
}

namespace {

std::vector<ConstantScore> sums_of_blocks(const std::vector<ConstantScore>& scores) {
  constexpr double kShortest = 30.0;  // s: errors of GNSS last for seconds to a minute
  constexpr double kMost = 40.0;      // more blocks add little certainty, longer ones cover longer errors
  const geo::GpsTime begin = scores.front().t;
  const double duration = scores.back().t - begin;
  const double count = std::max(1.0, std::floor(std::min(kMost, duration / kShortest)));
  const double length = duration / count;
  std::vector<ConstantScore> blocks;
  double last = -1.0;
  for (const ConstantScore& one : scores) {
    const double block = duration > 0.0 ? std::min(count - 1.0, std::floor((one.t - begin) / length)) : 0.0;
    if (block > last) {
      last = block;
      blocks.push_back(one);
      continue;
    }
    blocks.back().score += one.score;
    blocks.back().information += one.information;
  }
  return blocks;
}

/// Two-sided 95 % quantile over that of the normal distribution. Abramowitz & Stegun (1964) eq. 26.7.5, to 1 % from 3 degrees
/// of freedom on.
double student_over_normal(double freedom) {
  constexpr double z = 1.959964;
  constexpr double z2 = z * z;
  const double by = 1.0 / freedom;
  return 1.0 + by * ((z2 + 1.0) / 4.0 +
                     by * (((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0 + by * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0));
}

}  // namespace

namespace {

/// Influence of blocks on the estimates, C e, and what the model says of it: diagonals, summed over the blocks.
struct Influence {
  Eigen::VectorXd seen, expected;
  Eigen::VectorXd squares;  ///< of the expected variances of single blocks
};

Influence influence_of(const std::vector<ConstantScore>& blocks, const Eigen::MatrixXd& C, const Eigen::VectorXd& estimate) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(estimate.size());
  Influence sum{none, none, none};
  for (const ConstantScore& b : blocks) {
    const Eigen::MatrixXd CI = C * b.information;
    const Eigen::VectorXd variance = (CI * C - CI * C * CI.transpose()).diagonal();
    sum.seen += (C * (b.score - b.information * estimate)).cwiseAbs2();
    sum.expected += variance;
    sum.squares += variance.cwiseAbs2();
  }
  return sum;
}

}  // namespace

BlockScatter block_scatter(const std::vector<ConstantScore>& scores, const Eigen::VectorXd& prior) {
  constexpr double kByChance = 0.05;
  constexpr double kFewest = 5.0;  // degrees of freedom
  const Eigen::Index p = prior.size();
  BlockScatter result{Eigen::VectorXd::Ones(p), Eigen::VectorXd::Ones(p), Eigen::VectorXd::Zero(p)};
  if (scores.empty()) return result;
  const std::vector<ConstantScore> blocks = sums_of_blocks(scores);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(p);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  for (const ConstantScore& b : blocks) {
    score += b.score;
    information += b.information;
  }
  const Eigen::LLT<Eigen::MatrixXd> solver(information + Eigen::MatrixXd(prior.asDiagonal()));
  if (solver.info() != Eigen::Success) return result;
  const Eigen::MatrixXd C = solver.solve(Eigen::MatrixXd::Identity(p, p));
  const Influence sum = influence_of(blocks, C, C * score);
  const Eigen::VectorXd of_data = (C * information * C).diagonal();
  for (Eigen::Index i = 0; i < p; ++i) {
    if (!(sum.expected(i) > 0.0)) continue;
    const double freedom = result.freedom(i) = sum.expected(i) * sum.expected(i) / sum.squares(i);
    const double ratio = result.ratio(i) = sum.seen(i) / sum.expected(i);
    if (freedom < kFewest || ratio * freedom < noise::chi2_upper_quantile(freedom, kByChance)) continue;
    const double student = student_over_normal(freedom);
    result.factor(i) = std::sqrt(1.0 + std::max(0.0, ratio * student * student - 1.0) * of_data(i) / C(i, i));
  }
  return result;
}

}  // namespace coast::estimate
