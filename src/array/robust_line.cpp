#include "robust_line.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

/// Weighted least squares; x is divided by its span, so that the normal matrix is well scaled.
struct LineSolution {
  Eigen::Vector2d line;
  Eigen::Matrix2d covariance;
};

LineSolution solve_line(const std::vector<LinePoint>& points, const RobustLine& fit, double span) {
  Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d a(1.0, (points[i].x - fit.reference) / span);
    const double weight = fit.weights[i] / (points[i].sigma * points[i].sigma);
    N += weight * a * a.transpose();
    u += weight * points[i].y * a;
  }
  LineSolution solution;
  solution.covariance = N.inverse();
  solution.line = solution.covariance * u;
  return solution;
}

std::vector<double> line_residuals(const std::vector<LinePoint>& points, const RobustLine& fit) {
  std::vector<double> residuals;
  residuals.reserve(points.size());
  for (const LinePoint& point : points) residuals.push_back((point.y - fit.at(point.x)) / point.sigma);
  return residuals;
}

/// Factor on the variance of a mean by correlation of neighbouring errors.
double correlation_factor(const std::vector<double>& residuals, const std::vector<double>& weights) {
  double together = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    squares += weights[i] * residuals[i] * residuals[i];
    if (i > 0) together += std::sqrt(weights[i] * weights[i - 1]) * residuals[i] * residuals[i - 1];
  }
  const double rho = squares > 0.0 ? std::min(together / squares, 0.9) : 0.0;
  return rho > 2.0 / std::sqrt(static_cast<double>(residuals.size())) ? (1.0 + rho) / (1.0 - rho) : 1.0;
}

}  // namespace

double biweight(double standardised) {
  constexpr double kTuning = 4.685;
  const double u = standardised / kTuning;
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

double robust_scale(std::vector<double> standardised, double parameters) {
  for (double& r : standardised) r = std::abs(r);
  const auto middle = standardised.begin() + static_cast<std::ptrdiff_t>(standardised.size() / 2);
  std::nth_element(standardised.begin(), middle, standardised.end());
  const double n = static_cast<double>(standardised.size());
  return 1.4826 * *middle * std::sqrt(n / std::max(n - parameters, 1.0));
}

RobustLine fit_line(const std::vector<LinePoint>& points, double reference, Sigmas sigmas) {
  constexpr int kHuberSteps = 10;
  constexpr int kSteps = 25;
  constexpr double kHuber = 1.345;
  RobustLine fit;
  fit.reference = reference;
  fit.weights.assign(points.size(), 1.0);
  const double span = points.back().x - points.front().x;
  LineSolution solution;
  for (int step = 0; step < kSteps; ++step) {
    solution = solve_line(points, fit, span);
    fit.value = solution.line(0);
    fit.slope = solution.line(1) / span;
    const std::vector<double> residuals = line_residuals(points, fit);
    fit.scale = robust_scale(residuals, 2.0);
    if (sigmas == Sigmas::kAbsolute || points.size() == 2) fit.scale = std::max(fit.scale, 1.0);
    if (!(fit.scale > 1e-12)) break;  // all on the line except for rounding
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double r = residuals[i] / fit.scale;
      fit.weights[i] = step < kHuberSteps ? std::min(1.0, kHuber / std::max(std::abs(r), 1e-12)) : biweight(r);
    }
  }
  const double variance = fit.scale * fit.scale * correlation_factor(line_residuals(points, fit), fit.weights);
  fit.value_sigma = std::sqrt(variance * solution.covariance(0, 0));
  fit.slope_sigma = std::sqrt(variance * solution.covariance(1, 1)) / span;
  return fit;
}

}  // namespace coast::array
