#pragma once

namespace coast::noise {

/// P(X > x) for X ~ chi2(dof).
///
/// @param dof  degrees of freedom, > 0; need not be an integer
/// @note  Relative error below 1e-12 up to dof 1000, by the incomplete gamma function's series and continued fraction; beyond,
///        Wilson & Hilferty's cube root, absolute error below 2e-5, quantiles between 0.025 and 0.975 to 2e-6 of themselves.
/// @see   Abramowitz & Stegun (1964) eqs. 6.5.29, 6.5.31, 26.4.14
[[nodiscard]] double chi2_survival(double dof, double x);
/// Natural logarithm of chi2_survival, also where that underflows.
[[nodiscard]] double chi2_log_survival(double dof, double x);
/// x with P(X > x) = p.  @param p in (0, 1)
[[nodiscard]] double chi2_upper_quantile(double dof, double p);

}  // namespace coast::noise
