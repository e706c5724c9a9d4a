#pragma once

#include <optional>
#include <span>
#include <vector>

namespace coast::noise {

/// Partial autocorrelations of x[k] = a1 x[k-1] + ... + ap x[k-p] + e[k], the parameters of the estimable "ar"; nothing if the
/// series is not stationary. By the inverse Levinson-Durbin recursion.
[[nodiscard]] std::optional<std::vector<double>> partial_autocorrelations(std::span<const double> coefficients);

}  // namespace coast::noise
