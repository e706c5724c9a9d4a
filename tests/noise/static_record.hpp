#pragma once
// Static records simulated from a block, and the same block as one dense multivariate normal.

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <vector>

#include "coast/noise/static_signal.hpp"
#include "coast/noise/sum_model.hpp"

namespace coast::test {

/// Logarithms: what positive parameters are inside.
inline std::vector<double> logs(std::vector<double> values) {
  for (double& value : values) value = std::log(value);
  return values;
}

inline noise::SumModel sum(const std::vector<const char*>& names, noise::Mean mean) {
  std::vector<const noise::Estimable*> processes;
  for (const char* name : names) processes.push_back(&noise::estimable(name));
  return {processes, mean};
}

inline Eigen::MatrixXd square_root(const Eigen::MatrixXd& P) {
  if (P.size() == 0) return P;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(P);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// y[k] = h x[k] + v[k], as written.
inline std::vector<double> simulate_block(const noise::SampleBlock& block, std::size_t n, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    Eigen::VectorXd w(block.h.size());
    for (double& element : w) element = normal(generator);
    return w;
  };
  const Eigen::MatrixXd first = square_root(block.P_first), step = square_root(block.Q);
  Eigen::VectorXd x = first * draw();
  std::vector<double> y(n);
  for (double& sample : y) {
    sample = block.h.dot(x) + std::sqrt(block.white) * normal(generator);
    x = (block.Phi * x + step * draw()).eval();
  }
  return y;
}

/// All states of all grid points and all samples as one normal vector.
struct DenseModel {
  Eigen::MatrixXd states;   ///< covariance of (x[1], ..., x[n]) stacked
  Eigen::MatrixXd cross;    ///< of states with samples
  Eigen::MatrixXd samples;  ///< of the samples
  Eigen::MatrixXd means;    ///< regressors of the samples: 1, tau
  Eigen::VectorXd y;
};

inline DenseModel dense(const noise::SampleBlock& block, const noise::StaticSignal& signal) {
  const auto n = static_cast<Eigen::Index>(signal.length()), s = block.h.size();
  DenseModel model;
  model.states.setZero(n * s, n * s);
  Eigen::MatrixXd P = block.P_first;
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::MatrixXd C = P;  // Cov(x[j], x[i]), j >= i
    for (Eigen::Index j = i; j < n; ++j) {
      model.states.block(j * s, i * s, s, s) = C;
      model.states.block(i * s, j * s, s, s) = C.transpose();
      C = (block.Phi * C).eval();
    }
    P = (block.Phi * P * block.Phi.transpose() + block.Q).eval();
  }
  const auto m = static_cast<Eigen::Index>(signal.values.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, n * s);
  model.means.resize(m, 2);
  model.y.resize(m);
  Eigen::Index row = 0;
  for (const auto& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i, ++row) {
      const auto at = static_cast<Eigen::Index>(run.start + i);
      H.block(row, at * s, 1, s) = block.h;
      model.means.row(row) << 1.0, static_cast<double>(at) - 0.5 * static_cast<double>(n - 1);
      model.y(row) = signal.values[run.first + i];
    }
  model.cross = model.states * H.transpose();
  model.samples = H * model.cross + block.white * Eigen::MatrixXd::Identity(m, m);
  return model;
}

}  // namespace coast::test
