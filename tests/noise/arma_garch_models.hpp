#pragma once
// Models and series with holes for the ARMA-GARCH tests, and their likelihood as it is written, sample by sample.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coast/noise/arma_garch.hpp"

namespace coast::test {

inline noise::ArmaGarch small_arma_garch(const noise::ArmaGarchOrders& orders) {
  const auto first = [](std::vector<double> values, int count) {
    values.resize(static_cast<std::size_t>(count));
    return values;
  };
  return {.nu = 0.3,
          .alpha = first({0.5, 0.2, -0.3}, orders.ar),
          .beta = first({0.4, 0.25}, orders.ma),
          .gamma0 = 0.2,
          .gamma = first({0.15, 0.1}, orders.arch),
          .delta = first({0.4, 0.2}, orders.garch)};
}

/// AR roots 0.9 and 0.2 +- 0.6i, MA roots -0.3 +- 0.4i.
inline noise::ArmaGarch separated_arma_garch() {
  return {.nu = 0.02, .alpha = {1.3, -0.76, 0.36}, .beta = {0.6, 0.25}, .gamma0 = 0.05, .gamma = {0.08}, .delta = {0.87}};
}

inline std::vector<double> simulated_arma_garch(const noise::ArmaGarch& model, std::size_t n, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  return noise::simulate_arma_garch(model, n, generator);
}

/// The first sample, single ones, and a run of them.
inline std::vector<std::uint8_t> some_missing_samples(std::size_t n) {
  std::vector<std::uint8_t> is_missing(n, 0);
  for (const std::size_t t : {std::size_t{0}, n / 7, n / 5, n / 5 + 2}) is_missing[t] = 1;
  for (std::size_t t = n / 2; t < n / 2 + 11; ++t) is_missing[t] = 1;
  return is_missing;
}

/// In the likelihood: there, and none missing among the five before.
inline bool counts_in_likelihood(std::span<const std::uint8_t> is_missing, std::size_t t) {
  if (is_missing.empty()) return true;
  for (std::size_t k = 0; k <= std::min<std::size_t>(t, 5); ++k)
    if (is_missing[t - k] != 0) return false;
  return true;
}

/// Terms of the log-likelihood, one per sample: eqs. (8) and (9) of Stebler et al. (2011) in their own parameters, with a lag
/// that asks for a time before the first sample answered by the convention.
inline std::vector<double> terms_as_written(const noise::ArmaGarch& m, const noise::ArmaGarchSeries& series,
                                            noise::ArmaGarchStart start) {
  using Values = std::vector<double>;
  const bool fgarch = start == noise::ArmaGarchStart::kFgarch;
  const std::size_t n = series.y.size();
  const auto missing = [&](std::size_t t) { return !series.is_missing.empty() && series.is_missing[t] != 0; };
  const auto lagged = [](const Values& values, std::size_t t, std::size_t lag, double before) {
    return t >= lag ? values[t - lag] : before;
  };
  Values y(series.y.begin(), series.y.end()), e(n), e2(n), s2(n), terms(n, 0.0);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t < n; ++t) {
    double expected = m.nu;
    for (std::size_t i = 1; i <= m.alpha.size(); ++i) expected += m.alpha[i - 1] * lagged(y, t, i, m.mean());
    for (std::size_t j = 1; j <= m.beta.size(); ++j) expected += m.beta[j - 1] * lagged(e, t, j, 0.0);
    if (missing(t)) y[t] = expected;
    e[t] = fgarch && t < std::max(m.alpha.size(), m.beta.size()) ? 0.0 : y[t] - expected;
    if (!counts_in_likelihood(series.is_missing, t)) continue;
    sum += e[t] * e[t];
    count += 1.0;
  }
  const double before = sum / count;
  for (std::size_t t = 0; t < n; ++t) {
    s2[t] = m.gamma0;
    const bool held = fgarch && t < std::max(m.gamma.size(), m.delta.size());
    for (std::size_t i = 1; i <= m.gamma.size(); ++i) s2[t] += m.gamma[i - 1] * (held ? before : lagged(e2, t, i, before));
    for (std::size_t j = 1; j <= m.delta.size(); ++j) s2[t] += m.delta[j - 1] * (held ? before : lagged(s2, t, j, before));
    e2[t] = !counts_in_likelihood(series.is_missing, t) ? s2[t] : e[t] * e[t];
    if (counts_in_likelihood(series.is_missing, t))
      terms[t] = -0.5 * (std::log(2.0 * std::numbers::pi * s2[t]) + e2[t] / s2[t]);
  }
  return terms;
}

}  // namespace coast::test
