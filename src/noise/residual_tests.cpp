#include "coast/noise/residual_tests.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "coast/noise/chi_square.hpp"

namespace coast::noise {

using Eigen::ArrayXd;
using Eigen::Index;

namespace {

ResidualTest chi2_test(double statistic, double dof) {
  return {statistic, dof, chi2_survival(dof, statistic)};
}

ArrayXd about_mean(std::span<const double> values, const char* what) {
  const Eigen::Map<const ArrayXd> all(values.data(), std::ssize(values));
  ArrayXd centred = all - all.mean();
  // Rounding of the mean leaves residuals of this size if all values are equal.
  const double rounding = 1e-14 * all.abs().maxCoeff();
  if (!(centred.abs().maxCoeff() > rounding)) throw std::invalid_argument(fmt::format("{}: values that are all alike", what));
  return centred;
}

}  // namespace

ResidualTest ljung_box(std::span<const double> residuals, int lags, int fitted) {
  const Index n = std::ssize(residuals);
  if (lags < 1 || lags >= n || fitted < 0 || fitted >= lags)
    throw std::invalid_argument(fmt::format("ljung_box: {} lags and {} fitted of {} residuals", lags, fitted, n));
  const Eigen::VectorXd e = about_mean(residuals, "ljung_box").matrix();
  double sum = 0.0;
  for (Index k = 1; k <= lags; ++k) {
    const double rho = e.head(n - k).dot(e.tail(n - k)) / e.squaredNorm();
    sum += rho * rho / static_cast<double>(n - k);
  }
  const auto count = static_cast<double>(n);
  return chi2_test(count * (count + 2.0) * sum, lags - fitted);
}

ResidualTest arch_lm(std::span<const double> residuals, int lags) {
  const Index n = std::ssize(residuals);
  if (lags < 1 || n < 2 * Index{lags} + 2)
    throw std::invalid_argument(fmt::format("arch_lm: {} lags of {} residuals", lags, n));
  const Eigen::VectorXd squares = Eigen::Map<const ArrayXd>(residuals.data(), n).square().matrix();
  const Index rows = n - lags;
  const Eigen::VectorXd now = squares.tail(rows);
  const double varies = about_mean({now.data(), static_cast<std::size_t>(rows)}, "arch_lm").square().sum();
  Eigen::MatrixXd regressors(rows, lags + 1);
  regressors.col(0).setOnes();
  for (Index k = 1; k <= lags; ++k) regressors.col(k) = squares.segment(lags - k, rows);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(regressors);
  const double left = (now - regressors * factor.solve(now)).squaredNorm();
  return chi2_test(static_cast<double>(rows) * (1.0 - left / varies), lags);
}

ResidualTest jarque_bera(std::span<const double> residuals) {
  constexpr std::size_t kFewest = 4;
  if (residuals.size() < kFewest) throw std::invalid_argument(fmt::format("jarque_bera: {} residuals", residuals.size()));
  const ArrayXd e = about_mean(residuals, "jarque_bera");
  const double variance = e.square().mean();
  const double skewness = e.cube().mean() / (variance * std::sqrt(variance));
  const double excess = e.square().square().mean() / (variance * variance) - 3.0;
  return chi2_test(static_cast<double>(residuals.size()) / 6.0 * (skewness * skewness + 0.25 * excess * excess), 2.0);
}

}  // namespace coast::noise
