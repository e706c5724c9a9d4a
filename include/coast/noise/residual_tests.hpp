#pragma once
// Tests whether the residuals of a model are white, of constant variance, and normal.

#include <span>

namespace coast::noise {

/// A test statistic that is asymptotically chi2(dof) under the null hypothesis, and the probability of a larger value.
struct ResidualTest {
  double statistic = 0.0;
  double dof = 0.0;
  double p_value = 1.0;
};

/// Null: no autocorrelation up to `lags`. Q = n (n + 2) sum rho_k^2/(n - k); Ljung & Box (1978).
/// @param residuals  standardised if their variance changes; their mean is removed
/// @param fitted     number of ARMA coefficients estimated from the same series: subtracted from the degrees of freedom
/// @throws std::invalid_argument  lags not in [1, n - 1], fitted not in [0, lags - 1], or all residuals are equal
[[nodiscard]] ResidualTest ljung_box(std::span<const double> residuals, int lags, int fitted = 0);

/// Null: squares do not depend on the `lags` squares before them. (n - lags) R^2 of that regression, with constant; Engle
/// (1982).
/// @throws std::invalid_argument  lags < 1, fewer than 2 lags + 2 residuals, or all squares are equal
[[nodiscard]] ResidualTest arch_lm(std::span<const double> residuals, int lags);

/// Null: normal. n/6 (skewness^2 + (kurtosis - 3)^2/4) with moments over n; Jarque & Bera (1987).
/// @throws std::invalid_argument  fewer than 4 residuals, or all equal
/// @note  converges slowly to chi2(2): with a few hundred normal residuals the p-values are not yet uniform
[[nodiscard]] ResidualTest jarque_bera(std::span<const double> residuals);

}  // namespace coast::noise
