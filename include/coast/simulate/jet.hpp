#pragma once
// Time derivatives by arithmetic on truncated Taylor series (forward-mode differentiation of higher order).

#include <array>
#include <cmath>
#include <cstddef>

namespace coast::simulate {

/// A function of time around an instant t, as Taylor coefficients c[k] = f^(k)(t) / k!, k = 0..Order.
/// Sums, products and the functions below are exact up to this order; the order is part of the type, so that a derivative that
/// was not computed cannot be used.
template <std::size_t Order>
struct Jet {
  std::array<double, Order + 1> c{};

  constexpr Jet() = default;
  constexpr explicit Jet(double constant) { c[0] = constant; }

  [[nodiscard]] constexpr double value() const { return c[0]; }
  /// k-th time derivative, k <= Order.
  [[nodiscard]] constexpr double derivative(std::size_t k) const {
    double factorial = 1.0;
    for (std::size_t i = 2; i <= k; ++i) factorial *= static_cast<double>(i);
    return c[k] * factorial;
  }

  constexpr Jet& operator+=(const Jet& b) {
    for (std::size_t k = 0; k <= Order; ++k) c[k] += b.c[k];
    return *this;
  }
  constexpr Jet& operator-=(const Jet& b) {
    for (std::size_t k = 0; k <= Order; ++k) c[k] -= b.c[k];
    return *this;
  }
  constexpr Jet& operator*=(double s) {
    for (double& x : c) x *= s;
    return *this;
  }
  friend constexpr Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend constexpr Jet operator-(Jet a, const Jet& b) { return a -= b; }
  friend constexpr Jet operator-(Jet a) { return a *= -1.0; }
  friend constexpr Jet operator*(Jet a, double s) { return a *= s; }
  friend constexpr Jet operator*(double s, Jet a) { return a *= s; }
  friend constexpr Jet operator+(Jet a, double s) {
    a.c[0] += s;
    return a;
  }
  friend constexpr Jet operator+(double s, Jet a) { return a + s; }
  /// Cauchy product.
  friend constexpr Jet operator*(const Jet& a, const Jet& b) {
    Jet p;
    for (std::size_t k = 0; k <= Order; ++k)
      for (std::size_t i = 0; i <= k; ++i) p.c[k] += a.c[i] * b.c[k - i];
    return p;
  }
  /// From a = q b, coefficient by coefficient; b.value() != 0.
  friend constexpr Jet operator/(const Jet& a, const Jet& b) {
    Jet q;
    for (std::size_t k = 0; k <= Order; ++k) {
      double rest = a.c[k];
      for (std::size_t i = 0; i < k; ++i) rest -= q.c[i] * b.c[k - i];
      q.c[k] = rest / b.c[0];
    }
    return q;
  }
};

/// df/dt, one order less.
template <std::size_t Order>
[[nodiscard]] constexpr Jet<Order - 1> rate(const Jet<Order>& f) {
  Jet<Order - 1> d;
  for (std::size_t k = 0; k < Order; ++k) d.c[k] = static_cast<double>(k + 1) * f.c[k + 1];
  return d;
}

/// The function with this value now and this rate: one order more.
template <std::size_t Order>
[[nodiscard]] constexpr Jet<Order + 1> integral(double value_now, const Jet<Order>& rate_of_change) {
  Jet<Order + 1> f(value_now);
  for (std::size_t k = 0; k <= Order; ++k) f.c[k + 1] = rate_of_change.c[k] / static_cast<double>(k + 1);
  return f;
}

/// The same function with fewer derivatives.
template <std::size_t Low, std::size_t Order>
[[nodiscard]] constexpr Jet<Low> truncated(const Jet<Order>& f) {
  static_assert(Low <= Order);
  Jet<Low> g;
  for (std::size_t k = 0; k <= Low; ++k) g.c[k] = f.c[k];
  return g;
}

template <std::size_t Order>
struct SinCos {
  Jet<Order> sin;
  Jet<Order> cos;
};

/// From s' = a' c and c' = -a' s.
template <std::size_t Order>
[[nodiscard]] SinCos<Order> sincos(const Jet<Order>& angle) {
  SinCos<Order> r;
  r.sin.c[0] = std::sin(angle.c[0]);
  r.cos.c[0] = std::cos(angle.c[0]);
  for (std::size_t k = 1; k <= Order; ++k) {
    for (std::size_t i = 1; i <= k; ++i) {
      const double slope = static_cast<double>(i) * angle.c[i] / static_cast<double>(k);
      r.sin.c[k] += slope * r.cos.c[k - i];
      r.cos.c[k] -= slope * r.sin.c[k - i];
    }
  }
  return r;
}

/// From (atan x)' = x' / (1 + x^2).
template <std::size_t Order>
[[nodiscard]] Jet<Order> atan(const Jet<Order>& x) {
  const Jet<Order - 1> low = truncated<Order - 1>(x);
  return integral(std::atan(x.value()), rate(x) / (1.0 + low * low));
}

}  // namespace coast::simulate
