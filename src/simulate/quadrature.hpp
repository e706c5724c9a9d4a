#pragma once

#include <vector>

namespace coast::simulate {

/// Gauss-Legendre rule on [0, 1]: weights add up to 1; exact for polynomials of degree 2 n - 1.
struct GaussLegendre {
  explicit GaussLegendre(int n);
  std::vector<double> node;
  std::vector<double> weight;
};

}  // namespace coast::simulate
