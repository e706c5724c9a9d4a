#pragma once
// Student's t distribution with any real degrees of freedom, and the tails of a sample.

#include <limits>
#include <vector>

namespace coast::fleet {

/// P(|T| > |t|); the normal distribution's for nu = infinity. Relative accuracy 1e-10.
[[nodiscard]] double student_two_sided(double t, double nu);
/// t with P(|T| > t) = p, 0 < p < 1.
[[nodiscard]] double student_two_sided_quantile(double p, double nu);
/// P(chi2_1 > x)
[[nodiscard]] double chi_square_1_tail(double x);

/// Degrees of freedom and scale of t-distributed values about zero.
struct Tails {
  double nu = std::numeric_limits<double>::infinity();  ///< infinity: normal
  double scale = 1.0;                                   ///< of the t distribution
};
/// Heaviest tails that the values do not contradict: the lower end of a one-sided 95 % profile interval of nu, from 2.5 to
/// infinity, with the scale that goes with it. Without values: normal, scale 1.
///
/// @param larger  how many more values there are, larger than all of these: those in question, which must not widen the tails
///                that they are judged by. Left out altogether they would be missed in the tails of what does not depart
[[nodiscard]] Tails heaviest_tails(const std::vector<double>& values, std::size_t larger = 0);
/// Likewise the likeliest.
[[nodiscard]] Tails likeliest_tails(const std::vector<double>& values, std::size_t larger = 0);

}  // namespace coast::fleet
