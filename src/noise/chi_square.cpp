#include "coast/noise/chi_square.hpp"

#include <cmath>
#include <limits>

namespace coast::noise {

namespace {

constexpr double kManyDof = 1000.0;

/// 1 - Q(a, x): Abramowitz & Stegun eq. 6.5.29, for x < a + 1, where its terms decrease from the first on.
double lower_by_series(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (double n = a + 1.0; term > sum * std::numeric_limits<double>::epsilon() / 4.0; n += 1.0) {
    term *= x / n;
    sum += term;
  }
  return sum;
}

/// Q(a, x): eq. 6.5.31, its even part, by Lentz's method, for x >= a + 1.
double upper_by_fraction(double a, double x) {
  double b = x + 1.0 - a;
  double c = std::numeric_limits<double>::infinity();
  double d = 1.0 / b;
  double value = d;
  double change = 0.0;
  for (double n = 1.0; std::abs(change - 1.0) > std::numeric_limits<double>::epsilon(); n += 1.0) {
    const double numerator = n * (a - n);
    b += 2.0;
    d = 1.0 / (b + numerator * d);
    c = b + numerator / c;
    change = c * d;
    value *= change;
  }
  return value;
}

/// Eq. 26.4.14: the cube root of chi2/dof is close to normal.
double survival_of_many(double dof, double x) {
  const double variance = 2.0 / (9.0 * dof);
  return 0.5 * std::erfc((std::cbrt(x / dof) - (1.0 - variance)) / std::sqrt(2.0 * variance));
}

}  // namespace

double chi2_survival(double dof, double x) {
  if (x <= 0.0) return 1.0;
  if (dof > kManyDof) return survival_of_many(dof, x);
  const double a = 0.5 * dof;
  const double half = 0.5 * x;
  const double scale = std::exp(a * std::log(half) - half - std::lgamma(a));
  return half < a + 1.0 ? 1.0 - scale * lower_by_series(a, half) : scale * upper_by_fraction(a, half);
}

double chi2_log_survival(double dof, double x) {
  const double a = 0.5 * dof;
  const double half = 0.5 * x;
  if (half < a + 1.0) return std::log(chi2_survival(dof, x));
  return a * std::log(half) - half - std::lgamma(a) + std::log(upper_by_fraction(a, half));
}

double chi2_upper_quantile(double dof, double p) {
  double low = 0.0;
  double high = dof;
  while (chi2_survival(dof, high) > p) high *= 2.0;
  for (int i = 0; i < 100 && high - low > 2.0 * std::numeric_limits<double>::epsilon() * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi2_survival(dof, middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace coast::noise
