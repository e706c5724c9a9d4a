#include "coast/noise/likelihood.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "kalman/passes.hpp"
#include "kalman/stationary_pass.hpp"

namespace coast::noise {

namespace {

/// Results for one record at one u: the sums, the maximising mean, and the log-likelihood there.
struct Concentrated {
  double log_likelihood = -std::numeric_limits<double>::infinity();  ///< restricted
  double at_mean = -std::numeric_limits<double>::infinity();         ///< maximised over level and drift
  MeanCurve curve;                                                   ///< in tau of the grid
  Eigen::MatrixXd normal;                                            ///< X' V^-1 X
};

/// log of |X'V^-1 X| / |X'X|: what estimating the mean subtracts from the log-likelihood, up to a constant.
double log_weight(const Eigen::MatrixXd& normal, const StaticSignal& signal) {
  const Eigen::Index m = normal.rows();
  if (m == 0) return 0.0;
  Eigen::Matrix2d plain = Eigen::Matrix2d::Zero();
  const GridTime time(signal);
  for (const StaticSignal::Run& run : signal.runs) {
    // Sums of tau = (i - c) s and of its square over i = start .. start + count - 1.
    const auto n = static_cast<double>(run.count);
    const double middle = 0.5 * (time.at(run.start) + time.at(run.start + run.count - 1));
    plain(0, 0) += n;
    plain(0, 1) += n * middle;
    plain(1, 1) += n * middle * middle + n * (n * n - 1.0) / 12.0 * time.step() * time.step();
  }
  plain(1, 0) = plain(0, 1);
  return std::log(normal.determinant() / plain.topLeftCorner(m, m).determinant());
}

Concentrated concentrate(const SampleBlock& block, const StaticSignal& signal, Mean mean) {
  const InnovationSums sums = innovation_pass(block, signal);
  Concentrated result;
  if (!sums.positive) return result;
  const Eigen::Index m = coefficients(mean);
  const Eigen::VectorXd right = sums.products.col(0).segment(1, m);
  result.normal = sums.products.block(1, 1, m, m);
  double squares = sums.products(0, 0);
  if (m > 0) {
    const Eigen::VectorXd x = result.normal.ldlt().solve(right);
    squares -= right.dot(x);
    result.curve.level = x(0);
    if (m > 1) result.curve.drift = x(1);
  }
  const auto n = static_cast<double>(signal.values.size());
  const double value = -0.5 * (n * std::log(2.0 * std::numbers::pi) + sums.log_determinant + squares);
  if (!std::isfinite(value)) return result;
  result.at_mean = value;
  const double restricted =
      value + 0.5 * (static_cast<double>(m) * std::log(2.0 * std::numbers::pi) - log_weight(result.normal, signal));
  if (std::isfinite(restricted)) result.log_likelihood = restricted;
  return result;
}

MeanEstimate in_seconds(const Concentrated& fit, const Detrended& record) {
  const Eigen::Index m = fit.normal.rows();
  const double per_second = GridTime(record.signal).step() / record.signal.interval;
  const Eigen::Vector2d units(1.0, per_second);
  MeanEstimate mean;
  mean.value = Eigen::Vector2d(record.level + fit.curve.level, record.slope + fit.curve.drift * per_second).head(m);
  mean.covariance =
      units.head(m).asDiagonal() * fit.normal.ldlt().solve(Eigen::MatrixXd::Identity(m, m)).eval() * units.head(m).asDiagonal();
  return mean;
}

/// Without drift in the model, the slope that was subtracted before is added again.
Detrended prepared(const StaticSignal& signal, Mean mean) {
  Detrended record = detrend(signal);
  if (mean == Mean::kLevelAndDrift) return record;
  const double middle = 0.5 * static_cast<double>(signal.length() - 1);
  const double level = mean == Mean::kZero ? record.level : 0.0;
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i)
      record.signal.values[run.first + i] +=
          level + record.slope * record.signal.interval * (static_cast<double>(run.start + i) - middle);
  record.slope = 0.0;
  record.level -= level;
  return record;
}

void add(const BlockMoments& more, BlockMoments& sum) {
  sum.first += more.first;
  sum.before += more.before;
  sum.lagged += more.lagged;
  sum.after += more.after;
  sum.transitions += more.transitions;
  sum.records += more.records;
  sum.residual += more.residual;
  sum.samples += more.samples;
}

/// Curves whose sum with independent normal coefficients has the covariance of the estimated mean.
std::vector<MeanCurve> doubt_of(const Concentrated& fit) {
  const Eigen::Index m = fit.normal.rows();
  if (m == 0) return {};
  const Eigen::MatrixXd root = fit.normal.inverse().llt().matrixL();
  std::vector<MeanCurve> curves;
  for (Eigen::Index c = 0; c < m; ++c) curves.push_back({root(0, c), m > 1 ? root(1, c) : 0.0});
  return curves;
}

BlockMoments of_term(const BlockMoments& all, const SumModel::Term& term) {
  BlockMoments own = all;
  const auto cut = [&](const Eigen::MatrixXd& m) {
    return Eigen::MatrixXd(m.block(term.state, term.state, term.states, term.states));
  };
  own.first = cut(all.first);
  own.before = cut(all.before);
  own.lagged = cut(all.lagged);
  own.after = cut(all.after);
  return own;
}

}  // namespace

Likelihood::Likelihood(const std::vector<StaticSignal>& records, SumModel model, std::size_t averaged)
    : model_(std::move(model)), averaged_(averaged) {
  for (const StaticSignal& record : records) {
    if (record.values.empty()) throw std::invalid_argument("Likelihood: a record without samples");
    if (record.interval != records.front().interval)
      throw std::invalid_argument(
          fmt::format("Likelihood: records at intervals of {} and {} s", records.front().interval, record.interval));
    records_.push_back(prepared(record, model_.mean()));
  }
  if (records_.empty()) throw std::invalid_argument("Likelihood: no record");
}

double Likelihood::samples() const {
  double n = 0.0;
  for (const Detrended& record : records_) n += static_cast<double>(record.signal.values.size());
  return n;
}

SignalScale Likelihood::scale() const {
  SignalScale scale{interval(), 0.0, 0.0};
  for (const Detrended& record : records_) {
    scale.duration = std::max(scale.duration, record.signal.duration());
    scale.variance = std::max(scale.variance, record.variance);
  }
  return scale;
}

LikelihoodValue Likelihood::value(const std::vector<double>& u) const {
  const SampleBlock block = model_.block(u, step());
  LikelihoodValue sum;
  for (const Detrended& record : records_) {
    const Concentrated fit = concentrate(block, record.signal, model_.mean());
    sum.log_likelihood += fit.log_likelihood;
    sum.at_mean += fit.at_mean;
    if (std::isfinite(fit.log_likelihood)) sum.means.push_back(in_seconds(fit, record));
  }
  return sum;
}

// The mean maximises the likelihood, so the gradient at a fixed mean is that of the maximum over it; log |X'V^-1 X| adds its
// own.
LikelihoodSlope Likelihood::slope_with(const std::vector<double>& u, const Eigen::MatrixXd* information) const {
  const SampleBlock block = model_.block(u, step());
  const std::vector<SampleBlock> derivatives = model_.derivatives(u, step());
  const auto p = static_cast<Eigen::Index>(u.size());
  LikelihoodSlope sum{0.0, Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p)};
  for (const Detrended& record : records_) {
    const Concentrated fit = concentrate(block, record.signal, model_.mean());
    sum.log_likelihood += fit.log_likelihood;
    if (!std::isfinite(fit.log_likelihood)) return sum;
    const auto known = information != nullptr ? stationary_score(block, derivatives, record.signal, fit.curve) : std::nullopt;
    const ScoreSums score = known ? *known : score_pass(block, derivatives, record.signal, fit.curve);
    sum.gradient += score.gradient;
    const Eigen::Index m = fit.normal.rows();
    if (m > 0) {
      const Eigen::MatrixXd inverse = fit.normal.inverse();
      for (Eigen::Index i = 0; i < p; ++i)
        sum.gradient(i) -= 0.5 * (inverse * score.products[static_cast<std::size_t>(i)].topLeftCorner(m, m)).trace();
    }
    if (information == nullptr) sum.information += score.information;
  }
  if (information != nullptr) sum.information = *information;
  return sum;
}

LikelihoodSlope Likelihood::slope(const std::vector<double>& u) const {
  return slope_with(u, nullptr);
}

LikelihoodSlope Likelihood::slope(const std::vector<double>& u, const Eigen::MatrixXd& information) const {
  return slope_with(u, &information);
}

Likelihood::Expectation Likelihood::expectation(const std::vector<double>& u, std::vector<double>& memory) const {
  const SampleBlock block = model_.block(u, step());
  Expectation result;
  const Eigen::Index n = block.h.size();
  BlockMoments sum;
  SmootherScratch scratch{std::move(memory)};
  sum.first = sum.before = sum.lagged = sum.after = Eigen::MatrixXd::Zero(n, n);
  for (const Detrended& record : records_) {
    const Concentrated fit = concentrate(block, record.signal, model_.mean());
    result.log_likelihood += fit.log_likelihood;
    if (!std::isfinite(fit.log_likelihood)) return result;
    add(moment_pass(block, record.signal, fit.curve, doubt_of(fit), scratch), sum);
  }
  memory = std::move(scratch.steps);
  for (const SumModel::Term& term : model_.terms()) result.moments.push_back(of_term(sum, term));
  return result;
}

std::vector<double> Likelihood::standardised_innovations(const std::vector<double>& u, std::size_t record, double gate) const {
  const SampleBlock block = model_.block(u, step());
  const StaticSignal& signal = records_.at(record).signal;
  return whitening_pass(block, signal, concentrate(block, signal, model_.mean()).curve, gate);
}

}  // namespace coast::noise
