#include <algorithm>
#include <cmath>

#include "arma_garch_checks.hpp"
#include "autoregression.hpp"

namespace coast::noise {

namespace {

/// Samples after which the effect of a start is below 1e-13, by the slowest root of mean and variance.
std::size_t samples_to_forget(const ArmaGarch& model) {
  constexpr double kDecades = 30.0;  // exp(-30) = 1e-13
  constexpr double kMost = 1e6;
  double slowest = model.persistence();
  if (!model.alpha.empty())
    slowest = std::max(
        slowest, Autoregression::largest_pole(Eigen::Map<const Eigen::VectorXd>(model.alpha.data(), std::ssize(model.alpha))));
  return 100 + static_cast<std::size_t>(std::min(kMost, kDecades / (1.0 - slowest)));
}

}  // namespace

std::vector<double> simulate_arma_garch(const ArmaGarch& model, std::size_t n, std::mt19937_64& generator) {
  check_arma_garch(model);
  const std::size_t dropped = samples_to_forget(model);
  const std::size_t lags = std::max({model.alpha.size(), model.beta.size(), model.gamma.size(), model.delta.size()});
  const std::size_t all = lags + dropped + n;
  std::vector<double> x(all, 0.0), e(all, 0.0), s2(all, model.innovation_variance());
  std::vector<double> square(all, model.innovation_variance());
  std::normal_distribution<double> normal;
  for (std::size_t t = lags; t < all; ++t) {
    s2[t] = model.gamma0;
    for (std::size_t i = 0; i < model.gamma.size(); ++i) s2[t] += model.gamma[i] * square[t - 1 - i];
    for (std::size_t j = 0; j < model.delta.size(); ++j) s2[t] += model.delta[j] * s2[t - 1 - j];
    x[t] = e[t] = std::sqrt(s2[t]) * normal(generator);
    square[t] = e[t] * e[t];
    for (std::size_t i = 0; i < model.alpha.size(); ++i) x[t] += model.alpha[i] * x[t - 1 - i];
    for (std::size_t j = 0; j < model.beta.size(); ++j) x[t] += model.beta[j] * e[t - 1 - j];
  }
  std::vector<double> y(x.end() - static_cast<std::ptrdiff_t>(n), x.end());
  for (double& value : y) value += model.mean();
  return y;
}

}  // namespace coast::noise
