// Relations between an axis and products of signals.

#include <algorithm>
#include <cmath>
#include <random>

#include "evidence/form_scan.hpp"

namespace coast::diagnose {

namespace {

/// Mean over an interval of every relation minus that over the mission, one row per relation.
Eigen::MatrixXd relation_means(const Disturbances& d, const MissionRun& run) {
  const std::vector<Relation>& all = relations();
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(all.size()), static_cast<Eigen::Index>(d.t.size()));
  Eigen::VectorXd count = Eigen::VectorXd::Zero(means.cols());
  run.for_each_sample([&](std::size_t, geo::GpsTime t, const Signals& signals) {
    const auto behind = std::ranges::upper_bound(d.t, t);
    const Eigen::Index k = std::max<std::ptrdiff_t>(0, behind - d.t.begin() - 1);
    const Eigen::VectorXd basic = basic_signals(signals);
    for (std::size_t j = 0; j < all.size(); ++j) means(static_cast<Eigen::Index>(j), k) += all[j].of(basic);
    count(k) += 1.0;
  });
  means = means * count.cwiseMax(1.0).cwiseInverse().asDiagonal();
  means.colwise() -= means.rowwise().mean().eval();  // the filter's biases absorb the rest
  return means;
}

/// The likeliest relation and axis on a part of the mission: scores by block, their variances by chance.
struct BlockScores {
  Eigen::MatrixXd score;     ///< relation and axis x block
  Eigen::MatrixXd variance;  ///< likewise
  [[nodiscard]] Eigen::VectorXd ratios(const Eigen::VectorXd& weights) const {
    const Eigen::ArrayXd s = (score * weights).array();
    return (s.square() / (variance * weights).array().max(1e-300)).matrix();
  }
};

double stability_of(const BlockScores& scores, Eigen::Index candidate) {
  constexpr int kHalves = 100;
  constexpr double kNear = 0.8;  // of the largest: relations that differ little exchange ranks by chance
  std::mt19937_64 engine(1);
  Eigen::VectorXd weights(scores.score.cols());
  weights.setZero();
  weights.head(weights.size() / 2).setOnes();
  int times = 0;
  for (int i = 0; i < kHalves; ++i) {
    std::shuffle(weights.begin(), weights.end(), engine);
    const Eigen::VectorXd ratios = scores.ratios(weights);
    if (ratios(candidate) >= kNear * ratios.maxCoeff()) ++times;
  }
  return static_cast<double>(times) / kHalves;
}

}  // namespace

std::optional<Form> likeliest_relation(const Examination& examination, const MissionRun& run) {
  constexpr Eigen::Index kBlocks = 10;
  const Disturbances& d = examination.disturbances;
  if (d.t.size() < kFewestIntervals || d.score[0].rows() < 3) return {};
  const Eigen::MatrixXd means = relation_means(d, run);
  const Eigen::Index count = means.rows();
  const auto intervals = static_cast<Eigen::Index>(d.t.size());
  BlockScores scores{Eigen::MatrixXd::Zero(count * kAxes, kBlocks), Eigen::MatrixXd::Zero(count * kAxes, kBlocks)};
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(d.score[0].rows() - 1);
  Eigen::VectorXd ratio = Eigen::VectorXd::Zero(count * kAxes);
  for (Eigen::Index axis = 0; axis < kAxes; ++axis) {
    const Eigen::MatrixXd a = d.score[static_cast<std::size_t>(axis)].cast<double>();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(count, a.rows());
    for (Eigen::Index block = 0; block < kBlocks; ++block) {
      const Eigen::Index from = intervals * block / kBlocks;
      const Eigen::Index length = intervals * (block + 1) / kBlocks - from;
      const Eigen::MatrixXd s = means.middleCols(from, length) * a.middleCols(from, length).transpose();
      scores.score.block(axis * count, block, count, 1) = s.col(0);
      scores.variance.block(axis * count, block, count, 1) =
          s.rightCols(a.rows() - 1).rowwise().squaredNorm() / static_cast<double>(a.rows() - 1);
      sum += s;
    }
    const Eigen::ArrayXd variance = sum.rightCols(a.rows() - 1).rowwise().squaredNorm() / static_cast<double>(a.rows() - 1);
    const Eigen::ArrayXXd ratios = sum.array().square().colwise() / variance.max(1e-300);
    ratio.segment(axis * count, count) = ratios.col(0).matrix();
    largest = largest.max(ratios.rightCols(a.rows() - 1).colwise().maxCoeff().transpose());
  }
  Eigen::Index best = 0;
  const double peak = ratio.maxCoeff(&best);
  const LargestByChance chance = LargestByChance::of({largest.begin(), largest.end()});
  const auto axis = static_cast<std::size_t>(best / count);
  return Form{
      unknown_relation(site_of(axis), static_cast<int>(axis % 3), relations()[static_cast<std::size_t>(best % count)].name),
      peak, chance.p_value(peak), std::log(static_cast<double>(ratio.size())), stability_of(scores, best)};
}

}  // namespace coast::diagnose
