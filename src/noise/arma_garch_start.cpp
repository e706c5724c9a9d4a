#include "arma_garch_start.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <limits>

namespace coast::noise {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// With 0 for missing samples: its autocovariances are then still those of some series, so that the Yule & Walker solution is
/// stationary.
VectorXd filled_series(const ArmaGarchSeries& series) {
  VectorXd x = Eigen::Map<const VectorXd>(series.y.data(), std::ssize(series.y));
  for (std::size_t t = 0; t < series.is_missing.size(); ++t)
    if (series.is_missing[t] != 0) x(static_cast<Index>(t)) = 0.0;
  return x;
}

VectorXd yule_walker(const VectorXd& x, Index order) {
  VectorXd r(order + 1);
  for (Index k = 0; k <= order; ++k) r(k) = x.head(x.size() - k).dot(x.tail(x.size() - k));
  MatrixXd R(order, order);
  for (Index i = 0; i < order; ++i)
    for (Index j = 0; j < order; ++j) R(i, j) = r(std::abs(i - j));
  return R.ldlt().solve(r.tail(order));
}

/// Residuals of a long autoregression replace e; then least squares on the lags of both.
VectorXd hannan_rissanen(const VectorXd& x, Index ar, Index ma) {
  const Index n = x.size();
  const Index order = std::min<Index>(20 + ar + ma, n / 5);
  const VectorXd a = yule_walker(x, order);
  VectorXd e = x;
  for (Index i = 0; i < order; ++i) e.tail(n - 1 - i) -= a(i) * x.head(n - 1 - i);
  const Index first = order + std::max(ar, ma);
  MatrixXd lags(n - first, ar + ma);
  for (Index i = 0; i < ar; ++i) lags.col(i) = x.segment(first - 1 - i, n - first);
  for (Index j = 0; j < ma; ++j) lags.col(ar + j) = e.segment(first - 1 - j, n - first);
  MatrixXd normal = lags.transpose() * lags;
  normal.diagonal() *= 1.0 + 1e-9;
  return normal.ldlt().solve(lags.transpose() * x.tail(n - first));
}

std::vector<VectorXd> arma_starts(const VectorXd& x, Index ar, Index ma) {
  if (ar + ma == 0) return {VectorXd(0)};
  std::vector<VectorXd> starts{hannan_rissanen(x, ar, ma)};
  if (ar > 0 && ma > 0) {
    starts.emplace_back(VectorXd::Zero(ar + ma));
    starts.back().head(ar) = yule_walker(x, ar);
  }
  starts.emplace_back(VectorXd::Zero(ar + ma));
  if (ar > 0) starts.back()(0) = 0.95;
  if (ma > 0) starts.back()(ar) = ar > 0 ? -0.8 : 0.3;
  return starts;
}

struct GarchGuess {
  double arch;   ///< sum of gamma
  double garch;  ///< sum of delta
};

}  // namespace

std::vector<VectorXd> arma_garch_starts(const ArmaGarchSeries& series, const ArmaGarchOrders& orders,
                                        ArmaGarchRecursion& recursion, const ArmaGarchCoordinates& coordinates) {
  constexpr std::array<GarchGuess, 3> kMoving{{{0.05, 0.9}, {0.15, 0.7}, {0.25, 0.2}}};
  const ArmaGarchLayout& layout = coordinates.layout();
  std::vector<VectorXd> starts;
  for (const VectorXd& arma : arma_starts(filled_series(series), layout.ar, layout.ma)) {
    VectorXd centred = VectorXd::Zero(layout.size());
    centred.segment(1, arma.size()) = arma;
    centred(layout.gamma0()) = 1.0;
    centred = coordinates.centred(coordinates.inside(centred));  // stationary and invertible from here on
    double best = -std::numeric_limits<double>::infinity();
    starts.emplace_back();
    for (const GarchGuess& guess : kMoving) {
      const double arch = orders.arch > 0 ? guess.arch : 0.0;
      const double garch = orders.garch > 0 ? guess.garch : 0.0;
      centred.segment(layout.gamma(), layout.arch).setConstant(arch / std::max(1, orders.arch));
      centred.segment(layout.delta(), layout.garch).setConstant(garch / std::max(1, orders.garch));
      static_cast<void>(recursion.value(centred));
      const std::span<const double> e = recursion.residuals();
      const double squares = Eigen::Map<const VectorXd>(e.data(), std::ssize(e)).squaredNorm();
      centred(layout.gamma0()) = squares / static_cast<double>(recursion.observations()) * (1.0 - arch - garch);
      const double value = recursion.value(centred);
      if (starts.back().size() > 0 && !(value > best)) continue;
      best = value;
      starts.back() = coordinates.inside(centred);
    }
  }
  return starts;
}

}  // namespace coast::noise
