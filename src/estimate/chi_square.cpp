#include "coast/estimate/chi_square.hpp"

#include <cmath>

#include "coast/geo/units.hpp"

namespace coast::estimate {

// Abramowitz & Stegun (1964) eqs. 26.4.4 and 26.4.5: even dof a Poisson sum, odd dof the normal tail and a sum.
double chi2_survival(int dof, double x) {
  if (x <= 0.0) return 1.0;
  const double half = 0.5 * x;
  double term = 0.0;
  double sum = 0.0;
  double k = 0.0;
  if (dof % 2 == 0) {
    term = std::exp(-half);
    sum = term;
    k = 1.0;
  } else {
    sum = std::erfc(std::sqrt(half));
    term = std::sqrt(half / geo::kPi) * 2.0 * std::exp(-half);
    k = 1.5;
    if (dof > 1) sum += term;
  }
  for (; 2.0 * k < dof; k += 1.0) {
    term *= half / k;
    if (2.0 * (k + 1.0) <= dof || dof % 2 == 0) sum += term;
  }
  return sum;
}

double chi2_upper_quantile(int dof, double p) {
  double low = 0.0;
  double high = 1.0;
  while (chi2_survival(dof, high) > p) high *= 2.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (chi2_survival(dof, middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace coast::estimate
