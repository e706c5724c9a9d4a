// Records simulated from a sum of processes, and smoothed components of a record.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "coast/noise/calibration.hpp"
#include "kalman/fixed_model.hpp"
#include "kalman/passes.hpp"

namespace coast::noise {

namespace {

/// Square root of a positive semidefinite matrix; driving noise may be singular, so no Cholesky.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& P) {
  if (P.size() == 0 || P.isDiagonal(0.0)) return P.cwiseMax(0.0).cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(P);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

template <int N>
std::vector<double> draw(const SampleBlock& block, std::uint64_t length, std::uint64_t seed) {
  const FixedModel<N> model(block);
  const Eigen::Index n = block.h.size();
  typename FixedModel<N>::Matrix step = FixedModel<N>::Matrix::Zero();
  typename FixedModel<N>::Matrix first = step;
  step.topLeftCorner(n, n) = square_root(block.Q);
  first.topLeftCorner(n, n) = square_root(block.P_first);
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  typename FixedModel<N>::Vector w = FixedModel<N>::Vector::Zero();
  const auto fresh = [&] {
    for (Eigen::Index i = 0; i < n; ++i) w(i) = normal(generator);
  };
  fresh();
  typename FixedModel<N>::Vector x = first * w;
  const double sd = std::sqrt(block.white);
  std::vector<double> values(length);
  for (double& value : values) {
    value = model.h.dot(x) + sd * normal(generator);
    fresh();
    x = (model.Phi * x + step * w).eval();
  }
  return values;
}

/// Level and drift as fitted, in tau of the grid.
MeanCurve mean_curve(const Likelihood& likelihood, const std::vector<double>& u, std::size_t record) {
  const Detrended& detrended = likelihood.records()[record];
  const Eigen::VectorXd fitted = likelihood.value(u).means[record].value;
  MeanCurve mean;
  if (fitted.size() > 0) mean.level = fitted(0) - detrended.level;
  if (fitted.size() > 1)
    mean.drift = (fitted(1) - detrended.slope) * detrended.signal.interval / GridTime(detrended.signal).step();
  return mean;
}

/// One row for each process with states; sets the names of the components.
Eigen::MatrixXd output_rows(const SumModel& model, const SampleBlock& block, SmoothedComponents& result) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(model.terms().size()), block.h.size());
  Eigen::Index count = 0;
  for (std::size_t t = 0; t < model.terms().size(); ++t) {
    const SumModel::Term& term = model.terms()[t];
    if (term.states == 0) continue;
    rows.row(count++).segment(term.state, term.states) = block.h.segment(term.state, term.states);
    result.components.push_back({fmt::format("{} {}", term.process->symbol(), t), {}, {}});
  }
  return rows.topRows(count);
}

/// Means of the signal over `stride` grid points, level and drift subtracted.
std::vector<double> binned(const StaticSignal& signal, const MeanCurve& mean, std::size_t stride, std::size_t bins) {
  const GridTime time(signal);
  std::vector<double> sums(bins, 0.0);
  std::vector<double> counts(bins, 0.0);
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::uint64_t at = run.start + i;
      const std::size_t bin = std::min(static_cast<std::size_t>(at) / stride, bins - 1);
      sums[bin] += signal.values[run.first + i] - mean.level - mean.drift * time.at(at);
      counts[bin] += 1.0;
    }
  for (std::size_t i = 0; i < bins; ++i) sums[i] = counts[i] > 0.0 ? sums[i] / counts[i] : 0.0;
  return sums;
}

}  // namespace

StaticSignal realisation(const SumModel& model, const std::vector<double>& u, double interval, std::uint64_t length,
                         std::uint64_t seed) {
  const SampleBlock block = model.block(u, interval);
  return StaticSignal::regular(with_size(block.h.size(), [&](auto size) { return draw<size()>(block, length, seed); }),
                               interval);
}

SmoothedComponents smoothed_components(const Likelihood& likelihood, const std::vector<double>& u, std::size_t record,
                                       std::size_t points) {
  const StaticSignal& signal = likelihood.records().at(record).signal;
  const SampleBlock block = likelihood.model().block(u, likelihood.step());
  const MeanCurve mean = mean_curve(likelihood, u, record);
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(signal.length()) / std::max<std::size_t>(1, points));
  SmoothedComponents result;
  const Eigen::MatrixXd outputs = output_rows(likelihood.model(), block, result);
  const SmoothedOutputs smoothed = smoothing_pass(block, outputs, signal, mean, stride);
  for (const std::uint64_t at : smoothed.at) result.time_s.push_back(static_cast<double>(at) * signal.interval);
  for (std::size_t c = 0; c < result.components.size(); ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    for (Eigen::Index i = 0; i < smoothed.mean.cols(); ++i) {
      result.components[c].value.push_back(smoothed.mean(row, i));
      result.components[c].sd.push_back(std::sqrt(std::max(0.0, smoothed.variance(row, i))));
    }
  }
  result.signal = binned(signal, mean, stride, smoothed.at.size());
  return result;
}

}  // namespace coast::noise
