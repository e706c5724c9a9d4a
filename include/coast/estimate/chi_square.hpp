#pragma once

namespace coast::estimate {

/// P(X > x) for X ~ chi2(dof), any dof >= 1, by the incomplete gamma function's finite sums. Relative error below 1e-12.
[[nodiscard]] double chi2_survival(int dof, double x);
/// x with P(X > x) = p. @param p in (0, 1)
[[nodiscard]] double chi2_upper_quantile(int dof, double p);

}  // namespace coast::estimate
