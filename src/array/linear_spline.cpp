#include "linear_spline.hpp"

#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

/// Normal equations of hat functions: symmetric and tridiagonal.
struct Tridiagonal {
  explicit Tridiagonal(std::size_t n) : diagonal(n, 0.0), beside(n, 0.0), right(n, 0.0) {}
  std::vector<double> diagonal;
  std::vector<double> beside;  ///< element (k, k + 1)
  std::vector<double> right;
};

/// Position of a point among the knots: in interval k, at a fraction of it.
struct SplinePlace {
  std::size_t k = 0;
  double fraction = 0.0;
};

std::vector<SplinePlace> spline_places(const std::vector<LinePoint>& points, const std::vector<double>& knots) {
  std::vector<SplinePlace> places;
  std::size_t k = 0;
  for (const LinePoint& point : points) {
    while (k + 2 < knots.size() && point.x > knots[k + 1]) ++k;
    places.push_back({k, (point.x - knots[k]) / (knots[k + 1] - knots[k])});
  }
  return places;
}

double spline_value(const std::vector<double>& values, const SplinePlace& at) {
  return values[at.k] + at.fraction * (values[at.k + 1] - values[at.k]);
}

/// Pivots from both ends: d_k + e_k - a_k is one over element (k, k) of the inverse.
void solve_tridiagonal(const Tridiagonal& system, std::vector<double>& values, std::vector<double>& variances) {
  const std::size_t n = system.diagonal.size();
  std::vector<double> down = system.diagonal, up = system.diagonal, right = system.right;
  for (std::size_t k = 1; k < n; ++k) {
    const double factor = system.beside[k - 1] / down[k - 1];
    down[k] -= factor * system.beside[k - 1];
    right[k] -= factor * right[k - 1];
  }
  values[n - 1] = right[n - 1] / down[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) {
    values[k] = (right[k] - system.beside[k] * values[k + 1]) / down[k];
    up[k] -= system.beside[k] * system.beside[k] / up[k + 1];
  }
  for (std::size_t k = 0; k < n; ++k) variances[k] = 1.0 / (down[k] + up[k] - system.diagonal[k]);
}

Tridiagonal spline_system(const std::vector<LinePoint>& points, const std::vector<SplinePlace>& places,
                          const std::vector<double>& weights, std::size_t knots) {
  Tridiagonal system(knots);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [k, right] = places[i];
    const double left = 1.0 - right, weight = weights[i] / (points[i].sigma * points[i].sigma);
    system.diagonal[k] += weight * left * left;
    system.diagonal[k + 1] += weight * right * right;
    system.beside[k] += weight * left * right;
    system.right[k] += weight * left * points[i].y;
    system.right[k + 1] += weight * right * points[i].y;
  }
  return system;
}

}  // namespace

LinearSpline fit_spline(const std::vector<LinePoint>& points, std::vector<double> knots) {
  constexpr int kHuberSteps = 5;
  constexpr int kSteps = 15;
  constexpr double kHuber = 1.345;
  constexpr double kLeast = 1e-3;  // of a weight: a knot with only outliers nearby must still have a value
  LinearSpline fit;
  fit.knots = std::move(knots);
  const std::size_t n = fit.knots.size();
  fit.values.assign(n, 0.0);
  fit.sigmas.assign(n, 0.0);
  const std::vector<SplinePlace> places = spline_places(points, fit.knots);
  std::vector<double> weights(points.size(), 1.0), residuals(points.size());
  double scale = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    solve_tridiagonal(spline_system(points, places, weights, n), fit.values, fit.sigmas);
    for (std::size_t i = 0; i < points.size(); ++i)
      residuals[i] = (points[i].y - spline_value(fit.values, places[i])) / points[i].sigma;
    scale = robust_scale(residuals, static_cast<double>(n));
    if (!(scale > 1e-12)) break;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double r = residuals[i] / scale;
      const double huber = std::min(1.0, kHuber / std::max(std::abs(r), 1e-12));
      weights[i] = std::max(kLeast, step < kHuberSteps ? huber : biweight(r));
    }
  }
  for (double& sigma : fit.sigmas) sigma = scale * std::sqrt(sigma);
  return fit;
}

}  // namespace coast::array
