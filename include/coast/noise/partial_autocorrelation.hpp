#pragma once

#include <optional>
#include <span>
#include <vector>

namespace coast::noise {

/// Partial autocorrelations of x[k] = a1 x[k-1] + ... + ap x[k-p] + e[k], what the estimable "ar" has as parameters; nothing
/// where the series is not stationary. Levinson & Durbin, backwards.
[[nodiscard]] std::optional<std::vector<double>> partial_autocorrelations(std::span<const double> coefficients);

}  // namespace coast::noise
