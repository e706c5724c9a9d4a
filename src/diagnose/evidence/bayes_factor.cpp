// Statistics of one or a few coefficients: covariance, Bayes factor, smallest detectable size.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "coast/diagnose/examination.hpp"

namespace coast::diagnose {

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information) {
  constexpr double kSame = 1e-6;  // of the variance: rounding
  const Eigen::VectorXd scale =
      information.diagonal().unaryExpr([](double of) { return of > 0.0 ? 1.0 / std::sqrt(of) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::VectorXd inverse = solver.eigenvalues().unaryExpr([](double of) { return of > kSame ? 1.0 / of : 0.0; });
  const Eigen::MatrixXd columns = scale.asDiagonal() * solver.eigenvectors();
  return columns * inverse.asDiagonal() * columns.transpose();
}

// A Cauchy distribution is a mixture of normal ones with sd = plausible/|n|, n standard normal, and so is the ratio.
double log_bayes_factor(double score, double information, double plausible) {
  constexpr int kParts = 48;
  constexpr double kFrom = -11.0;  // ln |n|
  constexpr double kTo = 1.4;
  constexpr double kStep = (kTo - kFrom) / kParts;
  std::array<double, kParts> parts{};
  double weights = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double n = std::exp(kFrom + (i + 0.5) * kStep);
    const double prior = n * n / (plausible * plausible);
    const double log_weight = std::log(n) - 0.5 * n * n;
    weights += std::exp(log_weight);
    parts[static_cast<std::size_t>(i)] =
        log_weight + 0.5 * (score * score / (information + prior) - std::log1p(information / prior));
  }
  const double largest = *std::ranges::max_element(parts);
  double sum = 0.0;
  for (const double part : parts) sum += std::exp(part - largest);
  return largest + std::log(sum / weights);
}

// Noncentral chi-square with one degree of freedom: sqrt of it is |N(delta, 1)|; the other tail is negligible.
double minimal_detectable(double sd, double threshold) {
  constexpr double kPower = 0.8416;  // the normal quantile of 0.8
  return sd * (std::sqrt(threshold) + kPower);
}

}  // namespace coast::diagnose
