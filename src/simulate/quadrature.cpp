#include "quadrature.hpp"

#include <cmath>
#include <numbers>

namespace coast::simulate {

// Newton's method on the Legendre polynomial from Tricomi's starting value; the weights from its derivative at the root.
// Press et al. (2007, 3rd ed.), section 4.6.1.
GaussLegendre::GaussLegendre(int n) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 8; ++iteration) {
      double p = 1.0;
      double before = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1.0);
      x -= p / slope;
    }
    sum += 1.0 / ((1.0 - x * x) * slope * slope);
    node.push_back(0.5 * (1.0 - x));
    weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  // Rounding near the ends is 1e-14; a constant must be integrated to rounding, as gravity is nearly constant.
  for (double& w : weight) w /= sum;
}

}  // namespace coast::simulate
