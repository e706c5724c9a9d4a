#include "coast/fleet/student.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/geo/units.hpp"

namespace coast::fleet {

namespace {

/// Continued fraction of the incomplete beta function, by Lentz's method; for x < (a + 1) / (a + b + 2).
/// NIST Handbook of Mathematical Functions (2010), eq. (8.17.22).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  double c = 1.0;
  double d = 1.0 / std::max(1.0 - (a + b) * x / (a + 1.0), kTiny);
  double h = d;
  for (int m = 1; m < 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    d = 1.0 / (1.0 + even * d);
    c = 1.0 + even / c;
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    d = 1.0 / (1.0 + odd * d);
    c = 1.0 + odd / c;
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return h;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

/// Of the density of t.
double log_constant(double inverse) {
  if (inverse == 0.0) return -0.5 * std::log(2.0 * geo::kPi);
  const double nu = 1.0 / inverse;
  return std::lgamma(0.5 * (nu + 1.0)) - std::lgamma(0.5 * nu) - 0.5 * std::log(nu * geo::kPi);
}

/// P(|T| > z), and what a value of which only this is known adds to n - sum w v^2 / s^2 = 0, the equation of the scale.
struct Beyond {
  double log_probability = 0.0;
  double share = 0.0;  ///< 2 z f(z) / P(|T| > z)
};
Beyond beyond(double z, double inverse) {
  constexpr double kFar = 30.0;  // the normal distribution's: first term of its asymptotic series, to 0.1 %
  if (inverse == 0.0 && z > kFar) return {log_constant(0.0) - 0.5 * z * z + std::log(2.0 / z), z * z + 1.0};
  const double probability = std::max(student_two_sided(z, inverse > 0.0 ? 1.0 / inverse : HUGE_VAL), 1e-300);
  const double log_f =
      log_constant(inverse) - (inverse > 0.0 ? 0.5 * (1.0 + 1.0 / inverse) * std::log1p(z * z * inverse) : 0.5 * z * z);
  return {std::log(probability), 2.0 * z * std::exp(log_f) / probability};
}

/// Values, and how many more there are of which only this is known: that they are larger than all of these.
struct Censored {
  const std::vector<double>& values;
  double bound = 0.0;  ///< largest of the values, by size
  double larger = 0.0;
};

/// Log-likelihood with 1/nu = inverse at the scale that is best for it, by expectation and maximisation.
double profile(const Censored& sample, double inverse, double& scale) {
  const auto n = static_cast<double>(sample.values.size());
  double s2 = scale * scale;
  double sum_log = 0.0;
  Beyond beyond_bound;
  for (int step = 0; step < 40; ++step) {
    double sum = 0.0;
    sum_log = 0.0;
    for (const double v : sample.values) {
      const double u = v * v * inverse / s2;
      sum += v * v * (1.0 + inverse) / (1.0 + u);
      sum_log += inverse > 0.0 ? (1.0 + 1.0 / inverse) * std::log1p(u) : v * v / s2;
    }
    beyond_bound = beyond(sample.bound / std::sqrt(s2), inverse);
    const double next = std::max((sum + s2 * sample.larger * beyond_bound.share) / n, 1e-300);
    const bool settled = std::abs(next - s2) < 1e-6 * s2;
    s2 = next;
    if (settled) break;
  }
  scale = std::sqrt(s2);
  return n * (log_constant(inverse) - std::log(scale)) - 0.5 * sum_log + sample.larger * beyond_bound.log_probability;
}

/// Tails with the largest 1/nu whose log-likelihood is at most half of `drop` below the best.
Tails tails_within(const std::vector<double>& values, std::size_t larger, double drop) {
  constexpr int kSteps = 40;
  constexpr double kMost = 0.4;  // 1/nu
  Tails tails;
  if (values.empty()) return tails;
  Censored sample{values, 0.0, static_cast<double>(larger)};
  for (const double v : values) sample.bound = std::max(sample.bound, std::abs(v));
  std::vector<double> likelihood(kSteps + 1);
  std::vector<double> scales(kSteps + 1);
  double scale = 1.0;
  for (int i = 0; i <= kSteps; ++i) {
    const auto at = static_cast<std::size_t>(i);
    likelihood[at] = profile(sample, kMost * i / kSteps, scale);
    scales[at] = scale;
  }
  const double best = *std::max_element(likelihood.begin(), likelihood.end());
  for (int i = kSteps; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    if (2.0 * (best - likelihood[at]) > drop) continue;
    if (i > 0) tails.nu = kSteps / (kMost * i);
    tails.scale = scales[at];
    break;
  }
  return tails;
}

}  // namespace

double student_two_sided(double t, double nu) {
  if (!std::isfinite(nu)) return std::erfc(std::abs(t) / std::sqrt(2.0));
  return incomplete_beta(0.5 * nu, 0.5, nu / (nu + t * t));
}

double student_two_sided_quantile(double p, double nu) {
  double low = 0.0;
  double high = 1.0;
  while (student_two_sided(high, nu) > p && high < 1e12) high *= 2.0;
  for (int step = 0; step < 80; ++step) {
    const double middle = 0.5 * (low + high);
    (student_two_sided(middle, nu) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double chi_square_1_tail(double x) {
  return std::erfc(std::sqrt(0.5 * std::max(x, 0.0)));
}

Tails heaviest_tails(const std::vector<double>& values, std::size_t larger) {
  constexpr double kNormal90 = 2.7055;  // chi-square with one degree of freedom, 90 %: one-sided 95 %
  return tails_within(values, larger, kNormal90);
}

Tails likeliest_tails(const std::vector<double>& values, std::size_t larger) {
  return tails_within(values, larger, 0.0);
}

}  // namespace coast::fleet
