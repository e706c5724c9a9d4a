#include "form_scan.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <unsupported/Eigen/FFT>

#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"

namespace coast::diagnose {

namespace {

constexpr std::size_t kFewest = 60;  // intervals

Site site_of(std::size_t row) {
  return row < 3 ? Site::kGyro : Site::kAccel;
}

/// A likelihood ratio of one degree of freedom that is as rare as a power that many times its mean, which has two.
double for_one_degree(double power_ratio) {
  return noise::chi2_upper_quantile(1.0, std::clamp(std::exp(-power_ratio), 1e-290, 1.0 - 1e-12));
}

/// Squared magnitudes of the transform of a row of scores, on a uniform grid twice as long as the mission.
class Periodogram {
 public:
  explicit Periodogram(const Disturbances& d) : d_(d) {
    std::vector<double> lengths = d.length;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    step_ = std::max(*middle, (d.t.back() - d.t.front()) / 1e6);
    size_ = 2;
    while (static_cast<double>(size_) * step_ < 2.0 * (d.t.back() - d.t.front() + step_)) size_ *= 2;
    transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }
  [[nodiscard]] Eigen::ArrayXcd of(const Eigen::MatrixXf& score, Eigen::Index row) {
    std::vector<double> grid(size_, 0.0);
    for (std::size_t k = 0; k < d_.t.size(); ++k) {
      const double at = (d_.t[k] - d_.t.front() + 0.5 * d_.length[k]) / step_;
      grid[std::min(size_ - 1, static_cast<std::size_t>(at))] += score(row, static_cast<Eigen::Index>(k));
    }
    std::vector<std::complex<double>> spectrum;
    transform_.fwd(spectrum, grid);
    return Eigen::Map<Eigen::ArrayXcd>(spectrum.data(), static_cast<Eigen::Index>(spectrum.size()));
  }
  [[nodiscard]] double frequency(double bin) const { return bin / (static_cast<double>(size_) * step_); }
  [[nodiscard]] Eigen::Index bins() const { return static_cast<Eigen::Index>(size_ / 2); }

 private:
  const Disturbances& d_;
  double step_ = 0.0;
  std::size_t size_ = 0;
  Eigen::FFT<double> transform_;
};

struct Line {
  double ratio = 0.0;  ///< power over its mean by chance
  std::size_t axis = 0;
  double bin = 0.0;
};

/// Mean over an interval of every relation less that over the mission, a row a relation.
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
  means.colwise() -= means.rowwise().mean().eval();  // the filter's biases take the rest
  return means;
}

/// Which relation of which axis is likeliest on a part of the mission: scores by block, their variances by chance.
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
  constexpr double kNear = 0.8;  // of the largest: relations that differ little change places by chance
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

std::optional<Proposal> strongest_line(const Examination& examination) {
  constexpr double kFewestPeriods = 4.0;
  const Disturbances& d = examination.disturbances;
  if (d.t.size() < kFewest || d.score[0].rows() < 3) return {};
  Periodogram periodogram(d);
  const double span = d.t.back() - d.t.front();
  const Eigen::Index first = static_cast<Eigen::Index>(std::ceil(kFewestPeriods / span / periodogram.frequency(1.0)));
  const Eigen::Index bins = periodogram.bins() - first;
  if (bins < 8) return {};
  Line line;
  double phase = 0.0;
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(d.score[0].rows() - 1);
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    Eigen::ArrayXXd power(d.score[axis].rows(), bins);
    Eigen::ArrayXcd recorded;
    for (Eigen::Index row = 0; row < power.rows(); ++row) {
      const Eigen::ArrayXcd spectrum = periodogram.of(d.score[axis], row).segment(first, bins);
      power.row(row) = spectrum.abs2().transpose();
      if (row == 0) recorded = spectrum;
    }
    const Eigen::ArrayXd mean = power.bottomRows(power.rows() - 1).colwise().mean().transpose();
    if (!(mean.minCoeff() > 0.0)) continue;
    const Eigen::ArrayXXd ratio = power.rowwise() / mean.transpose();
    largest = largest.max(ratio.bottomRows(ratio.rows() - 1).rowwise().maxCoeff());
    Eigen::Index at = 0;
    const double peak = ratio.row(0).maxCoeff(&at);
    if (peak <= line.ratio) continue;
    double shift = 0.0;  // of the vertex of the parabola through the peak and its neighbours
    if (at > 0 && at + 1 < bins) {
      const double curvature = ratio(0, at - 1) - 2.0 * peak + ratio(0, at + 1);
      if (curvature < 0.0) shift = 0.5 * (ratio(0, at - 1) - ratio(0, at + 1)) / curvature;
    }
    line = {peak, axis, static_cast<double>(first + at) + shift};
    phase = std::arg(recorded(at));
  }
  std::vector<double> ratios(static_cast<std::size_t>(largest.size()));
  std::ranges::transform(largest, ratios.begin(), for_one_degree);
  const LargestByChance chance = LargestByChance::of(std::move(ratios));
  // The phase only says where the two coefficients begin: they are found together.
  return Proposal{
      harmonic_disturbance(site_of(line.axis), static_cast<int>(line.axis % 3), periodogram.frequency(line.bin), phase),
      2.0 * line.ratio, chance.p_value(for_one_degree(line.ratio)), std::log(chance.count)};
}

std::optional<Proposal> likeliest_relation(const Examination& examination, const MissionRun& run) {
  constexpr Eigen::Index kBlocks = 10;
  const Disturbances& d = examination.disturbances;
  if (d.t.size() < kFewest || d.score[0].rows() < 3) return {};
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
  return Proposal{
      unknown_relation(site_of(axis), static_cast<int>(axis % 3), relations()[static_cast<std::size_t>(best % count)].name),
      peak, chance.p_value(peak), std::log(static_cast<double>(ratio.size())), stability_of(scores, best)};
}

}  // namespace coast::diagnose
