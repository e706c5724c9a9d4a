#pragma once
// Two methods on the same recordings: how much smaller the errors of one are, and how surely.

#include <cstddef>
#include <span>
#include <vector>

namespace coast::study {

/// Quantile by linear interpolation between order statistics (Hyndman and Fan, 1996, definition 7).
/// @param values not empty  @param p in [0, 1]
[[nodiscard]] double quantile(std::vector<double> values, double p);

/// Quantile of Student's t distribution. The distribution function is the finite trigonometric sum for whole degrees of
/// freedom, inverted by bisection: 12 digits.
/// @param p in (0, 1)  @param dof at least 1
/// @throws std::invalid_argument  an argument is outside its range
/// @see   Abramowitz and Stegun (1964), 26.7.3 and 26.7.4
[[nodiscard]] double student_t_quantile(double p, int dof);

/// Two-sided sign test: the probability that a fair coin, thrown first + second times, falls at least as unevenly.
[[nodiscard]] double sign_test(std::size_t first, std::size_t second);

/// Errors of a second method against those of a first, pair by pair.
struct PairedRatio {
  std::size_t pairs = 0;  ///< of positive errors; others are left out
  double ratio = 1.0;     ///< geometric mean of second : first; below 1 the second is better
  double low = 1.0;       ///< 95 % interval of it; low = ratio = high where there are fewer than two pairs, or none apart
  double high = 1.0;
  std::size_t second_smaller = 0;  ///< pairs
  std::size_t first_smaller = 0;
  double sign_test = 1.0;  ///< two-sided probability of so uneven a split if neither were better
};

/// With d_i = log(second_i / first_i), their mean m and standard deviation s over n pairs:
///
///     ratio = exp(m),   interval exp(m -+ t s / sqrt(n)),   t the 0.975 quantile of Student's t with n - 1 degrees of freedom
///
/// The interval supposes normal logarithms of ratios, or n large enough for their mean; the sign test supposes nothing.
/// @throws std::invalid_argument  the two differ in length
[[nodiscard]] PairedRatio paired_ratio(std::span<const double> first, std::span<const double> second);

/// The same of pairs that are not independent: two of them share what happened where their stretches of time overlap, and
/// their logarithms are taken to be correlated by that share, w_ij = max(0, 1 - |t_i - t_j| / reach). Then
///
///     variance of m = sum_i (d_i - m)^2 / n / (k - 1),   k = n^2 / sum_ij w_ij
///
/// without bias. k is the number of independent stretches that tell as much; t has k - 1 degrees of freedom, whole ones and at
/// least one: with few stretches the interval is wider than it need be. The sign test is left as it is, and is then too sure.
/// @param times  of the pairs, s  @param reach  length of a stretch, s
/// @throws std::invalid_argument  the three differ in length
[[nodiscard]] PairedRatio paired_ratio(std::span<const double> first, std::span<const double> second,
                                       std::span<const double> times, double reach);

}  // namespace coast::study
