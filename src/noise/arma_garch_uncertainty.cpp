#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "arma_garch_checks.hpp"
#include "arma_garch_recursion.hpp"

namespace coast::noise {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Minus the second derivatives, by central differences of the gradient over a small fraction of each parameter's deviation:
/// the truncation error is 1e-6 of the curvature's change over a standard deviation, the error by rounding 1e-8 of it.
MatrixXd observed_information(ArmaGarchRecursion& recursion, const VectorXd& centred, const MatrixXd& expected) {
  constexpr double kPart = 3e-3;
  MatrixXd A(centred.size(), centred.size());
  VectorXd above;
  VectorXd below;
  for (Index i = 0; i < centred.size(); ++i) {
    const double step = kPart / std::sqrt(expected(i, i));
    VectorXd at = centred;
    at(i) = centred(i) + step;
    recursion.slope(at, above);
    at(i) = centred(i) - step;
    recursion.slope(at, below);
    A.col(i) = (below - above) / (2.0 * step);
  }
  return 0.5 * (A + A.transpose());
}

/// None if A is not positive definite, after scaling to a unit diagonal.
std::optional<MatrixXd> inverse_of_definite(const MatrixXd& A) {
  if (!(A.diagonal().minCoeff() > 0.0)) return {};
  const VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<MatrixXd> factor(scale.asDiagonal() * A * scale.asDiagonal());
  constexpr double kSingular = 1e-10;  // differences of the gradient have errors of 1e-8, which cancel in part
  if (!(factor.vectorD().minCoeff() > kSingular)) return {};
  return MatrixXd(scale.asDiagonal() * factor.solve(MatrixXd::Identity(A.rows(), A.rows())) * scale.asDiagonal());
}

}  // namespace

double ArmaGarchUncertainty::robust_sd(Index parameter) const {
  return std::sqrt(robust(parameter, parameter));
}

std::optional<ArmaGarchUncertainty> arma_garch_uncertainty(const ArmaGarchFit& fit, const ArmaGarchSeries& series) {
  check_arma_garch(fit.model);
  check_arma_garch(series, fit.model.orders());
  ArmaGarchRecursion recursion(fit.model.orders(), series, fit.options.start);
  const VectorXd centred = centred_vector(fit.model);
  const MatrixXd expected = recursion.information(centred).expected;
  const MatrixXd scores = recursion.scores(centred);
  const MatrixXd A = observed_information(recursion, centred, expected);
  const Index free = fit.options.constant ? A.rows() : A.rows() - 1;
  const std::optional<MatrixXd> inverse = inverse_of_definite(A.bottomRightCorner(free, free));
  if (!inverse) return {};
  const MatrixXd used = scores.rightCols(free);
  const MatrixXd J = natural_by_centred(recursion.layout(), centred).bottomRightCorner(free, free);
  // At the maximum the gradient is zero, so that second derivatives transform as a tensor.
  const MatrixXd curvature = J * *inverse * J.transpose();
  const MatrixXd side = J * *inverse * used.transpose();
  return ArmaGarchUncertainty{side * side.transpose(), curvature};
}

std::vector<Interval> arma_garch_intervals(const ArmaGarchFit& fit, const ArmaGarchUncertainty& uncertainty) {
  constexpr double kTwoSided95 = 1.959963984540054;
  const VectorXd theta = arma_garch_vector(fit.model, fit.options.constant);
  std::vector<Interval> intervals;
  for (Index i = 0; i < theta.size(); ++i) {
    const double half = kTwoSided95 * uncertainty.robust_sd(i);
    intervals.push_back({theta(i) - half, theta(i) + half});
  }
  return intervals;
}

}  // namespace coast::noise
