#pragma once
// Compares the errors of two methods on the same recordings: ratio with confidence interval.

#include <cstddef>
#include <span>
#include <vector>

namespace coast::study {

/// Quantile by linear interpolation between order statistics (Hyndman and Fan, 1996, definition 7).
/// @param values not empty  @param p in [0, 1]
[[nodiscard]] double quantile(std::vector<double> values, double p);

/// Quantile of Student's t distribution. The distribution function is the finite trigonometric sum for integer degrees of
/// freedom, inverted by bisection: 12 digits.
/// @param p in (0, 1)  @param dof at least 1
/// @throws std::invalid_argument  an argument is outside its range
/// @see   Abramowitz and Stegun (1964), 26.7.3 and 26.7.4
[[nodiscard]] double student_t_quantile(double p, int dof);

/// Two-sided sign test: the probability of a split at least as uneven in first + second tosses of a fair coin.
[[nodiscard]] double sign_test(std::size_t first, std::size_t second);

/// Errors of a second method relative to those of a first, pair by pair.
struct PairedRatio {
  std::size_t pairs = 0;  ///< pairs of positive errors; others are left out
  double ratio = 1.0;     ///< geometric mean of second : first; below 1 the second is better
  double low = 1.0;       ///< 95 % interval of it; low = ratio = high with fewer than two pairs, or if no pair differs
  double high = 1.0;
  std::size_t second_smaller = 0;  ///< pairs
  std::size_t first_smaller = 0;
  double sign_test = 1.0;  ///< two-sided probability of a split at least as uneven if neither is better
};

/// With d_i = log(second_i / first_i), their mean m and standard deviation s over n pairs:
///
///     ratio = exp(m),   interval exp(m -+ t s / sqrt(n)),   t the 0.975 quantile of Student's t with n - 1 degrees of freedom
///
/// The interval assumes normal logarithms of ratios, or n large enough for their mean; the sign test makes no such assumption.
/// @throws std::invalid_argument  the two differ in length
[[nodiscard]] PairedRatio paired_ratio(std::span<const double> first, std::span<const double> second);

/// The same for pairs that are not independent because their periods overlap: the correlation of their logarithms is assumed to
/// be the overlapping share, w_ij = max(0, 1 - |t_i - t_j| / reach). Then
///
///     variance of m = sum_i (d_i - m)^2 / n / (k - 1),   k = n^2 / sum_ij w_ij
///
/// without bias. k is the equivalent number of independent periods; t has k - 1 degrees of freedom, rounded to an integer of at
/// least one: with few periods the interval is wider than necessary. The sign test is unchanged, and is then too significant.
/// @param times  of the pairs, s  @param reach  length of a period, s
/// @throws std::invalid_argument  the three differ in length
[[nodiscard]] PairedRatio paired_ratio(std::span<const double> first, std::span<const double> second,
                                       std::span<const double> times, double reach);

}  // namespace coast::study
