#include "coast/simulate/jet.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coast::simulate {
namespace {

// f(t) = 0.4 + 0.7 t - 0.3 t^2 + 0.11 t^3 around t = 0: the coefficients are the jet.
Jet<3> polynomial() {
  Jet<3> p;
  p.c = {0.4, 0.7, -0.3, 0.11};
  return p;
}

double polynomial_at(double t) {
  return 0.4 + 0.7 * t - 0.3 * t * t + 0.11 * t * t * t;
}

// k-th derivative at 0 by central differences of eighth order applied k times.
double numeric_derivative(const std::function<double(double)>& f, int k, double t = 0.0) {
  if (k == 0) return f(t);
  const double h = 0.02;
  const auto d = [&](double at) { return numeric_derivative(f, k - 1, at); };
  const auto difference = [&](int i) { return d(t + i * h) - d(t - i * h); };
  return (0.8 * difference(1) - 0.2 * difference(2) + 4.0 / 105.0 * difference(3) - difference(4) / 280.0) / h;
}

void expect_derivatives(const Jet<3>& jet, const std::function<double(double)>& f) {
  for (int k = 0; k <= 3; ++k)  // rounding 1e-16 / h^k, truncation h^8
    EXPECT_NEAR(jet.derivative(static_cast<std::size_t>(k)), numeric_derivative(f, k), 1e-9) << "order " << k;
}

TEST(Jet, ProductAndQuotientMatchFiniteDifferences) {
  Jet<3> q;
  q.c = {1.3, -0.2, 0.5, 0.0};
  const auto q_at = [](double t) { return 1.3 - 0.2 * t + 0.5 * t * t; };
  expect_derivatives(polynomial() * q, [&](double t) { return polynomial_at(t) * q_at(t); });
  expect_derivatives(polynomial() / q, [&](double t) { return polynomial_at(t) / q_at(t); });
}

TEST(Jet, FunctionsMatchFiniteDifferences) {
  expect_derivatives(sincos(polynomial()).sin, [](double t) { return std::sin(polynomial_at(t)); });
  expect_derivatives(sincos(polynomial()).cos, [](double t) { return std::cos(polynomial_at(t)); });
  expect_derivatives(atan(polynomial()), [](double t) { return std::atan(polynomial_at(t)); });
}

TEST(Jet, IntegralUndoesRate) {
  const Jet<3> p = polynomial();
  const Jet<3> again = integral(p.value(), rate(p));
  for (std::size_t k = 0; k <= 3; ++k) EXPECT_DOUBLE_EQ(again.c[k], p.c[k]);
}

}  // namespace
}  // namespace coast::simulate
