#pragma once
// Is what a model leaves white, of constant variance, normal?

#include <span>

namespace coast::noise {

/// A statistic that under the null is chi2(dof) for many samples, and the probability of more than it.
struct ResidualTest {
  double statistic = 0.0;
  double dof = 0.0;
  double p_value = 1.0;
};

/// Null: no autocorrelation up to `lags`. Q = n (n + 2) sum rho_k^2/(n - k); Ljung & Box (1978).
/// @param residuals  standardised if their variance changes; about their mean
/// @param fitted     number of ARMA coefficients estimated from the same series: taken off the degrees of freedom
/// @throws std::invalid_argument  lags not in [1, n - 1], fitted not in [0, lags - 1], or residuals that are all alike
[[nodiscard]] ResidualTest ljung_box(std::span<const double> residuals, int lags, int fitted = 0);

/// Null: squares do not depend on the `lags` squares before them. (n - lags) R^2 of that regression, with constant; Engle
/// (1982).
/// @throws std::invalid_argument  lags < 1, fewer than 2 lags + 2 residuals, or squares that are all alike
[[nodiscard]] ResidualTest arch_lm(std::span<const double> residuals, int lags);

/// Null: normal. n/6 (skewness^2 + (kurtosis - 3)^2/4) with moments over n; Jarque & Bera (1987).
/// @throws std::invalid_argument  fewer than 4 residuals, or all alike
/// @note  slow to become chi2(2): of few hundred normal residuals p-values are not yet uniform
[[nodiscard]] ResidualTest jarque_bera(std::span<const double> residuals);

}  // namespace coast::noise
