#include "coast/fleet/student.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Log-likelihood of the values with 1/nu = inverse at the scale that is best for it, by expectation and maximisation.
double profile(const std::vector<double>& values, double inverse, double& scale) {
  const auto n = static_cast<double>(values.size());
  double s2 = scale * scale;
  double sum_log = 0.0;
  for (int step = 0; step < 40; ++step) {
    double sum = 0.0;
    sum_log = 0.0;
    for (const double v : values) {
      const double u = v * v * inverse / s2;
      sum += v * v * (1.0 + inverse) / (1.0 + u);
      sum_log += inverse > 0.0 ? (1.0 + 1.0 / inverse) * std::log1p(u) : v * v / s2;
    }
    const double next = std::max(sum / n, 1e-300);
    const bool settled = std::abs(next - s2) < 1e-6 * s2;
    s2 = next;
    if (settled) break;
  }
  scale = std::sqrt(s2);
  double constant = -0.5 * std::log(2.0 * 3.14159265358979323846);
  if (inverse > 0.0) {
    const double nu = 1.0 / inverse;
    constant = std::lgamma(0.5 * (nu + 1.0)) - std::lgamma(0.5 * nu) - 0.5 * std::log(nu * 3.14159265358979323846);
  }
  return n * (constant - std::log(scale)) - 0.5 * sum_log;
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

Tails heaviest_tails(const std::vector<double>& values) {
  constexpr double kNormal95 = 2.7055;  // chi-square with one degree of freedom, 90 %: one-sided 95 %
  constexpr int kSteps = 40;
  constexpr double kMost = 0.4;  // 1/nu
  Tails tails;
  if (values.empty()) return tails;
  std::vector<double> likelihood(kSteps + 1);
  std::vector<double> scales(kSteps + 1);
  double scale = 1.0;
  for (int i = 0; i <= kSteps; ++i) {
    const auto at = static_cast<std::size_t>(i);
    likelihood[at] = profile(values, kMost * i / kSteps, scale);
    scales[at] = scale;
  }
  const double best = *std::max_element(likelihood.begin(), likelihood.end());
  for (int i = kSteps; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    if (2.0 * (best - likelihood[at]) > kNormal95) continue;
    if (i > 0) tails.nu = kSteps / (kMost * i);
    tails.scale = scales[at];
    break;
  }
  return tails;
}

}  // namespace coast::fleet
