#include "coast/noise/arma_garch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "arma_garch_checks.hpp"
#include "autoregression.hpp"

namespace coast::noise {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

double sum_of_all(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Roots of z^n - a_1 z^(n-1) - ...
Eigen::VectorXcd characteristic_roots(const std::vector<double>& a, double sign) {
  if (a.empty()) return {};
  return Autoregression::poles(sign * Eigen::Map<const VectorXd>(a.data(), std::ssize(a)));
}

double largest_modulus(const Eigen::VectorXcd& roots) {
  return roots.size() == 0 ? 0.0 : roots.cwiseAbs().maxCoeff();
}

}  // namespace

ArmaGarchOrders ArmaGarch::orders() const {
  const auto count = [](const std::vector<double>& values) { return static_cast<int>(values.size()); };
  return {count(alpha), count(beta), count(gamma), count(delta)};
}

std::string ArmaGarch::defect() const {
  const auto finite = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
  };
  const auto negative = [](double v) { return v < 0.0; };
  if (!std::isfinite(nu) || !std::isfinite(gamma0) || !finite(alpha) || !finite(beta) || !finite(gamma) || !finite(delta))
    return "a parameter that is not finite";
  if (gamma.empty() && !delta.empty()) return "delta without gamma";
  if (!(gamma0 > 0.0)) return fmt::format("gamma0 = {}, not above 0", gamma0);
  if (std::ranges::any_of(gamma, negative) || std::ranges::any_of(delta, negative)) return "a negative gamma or delta";
  if (!(persistence() < 1.0)) return fmt::format("gamma and delta whose sum is {}, not below 1", persistence());
  const double pole = largest_modulus(characteristic_roots(alpha, 1.0));
  if (!(pole < 1.0)) return fmt::format("not stationary: a root of alpha of modulus {}", pole);
  const double zero = largest_modulus(characteristic_roots(beta, -1.0));
  if (!(zero < 1.0)) return fmt::format("not invertible: a root of beta of modulus {}", zero);
  return {};
}

double ArmaGarch::mean() const {
  return nu / (1.0 - sum_of_all(alpha));
}
double ArmaGarch::persistence() const {
  return sum_of_all(gamma) + sum_of_all(delta);
}
double ArmaGarch::innovation_variance() const {
  return gamma0 / (1.0 - persistence());
}

std::vector<double> ArmaGarch::psi_weights(std::size_t count) const {
  std::vector<double> psi(count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    psi[k] = k == 0 ? 1.0 : k <= beta.size() ? beta[k - 1] : 0.0;
    for (std::size_t i = 1; i <= std::min(k, alpha.size()); ++i) psi[k] += alpha[i - 1] * psi[k - i];
  }
  return psi;
}

double ArmaGarch::unconditional_variance() const {
  if (alpha.empty()) {
    const auto squares = std::inner_product(beta.begin(), beta.end(), beta.begin(), 1.0);
    return innovation_variance() * squares;
  }
  // State (x[t], ..., x[t-r+1]) of the autoregression u, of which y is the moving average: y = u[t] + beta_1 u[t-1] + ...
  const std::size_t states = std::max(alpha.size(), beta.size() + 1);
  VectorXd padded = VectorXd::Zero(static_cast<Index>(states));
  std::ranges::copy(alpha, padded.begin());
  const Autoregression u(padded, 1.0);
  Autoregression::Column weights = Autoregression::Column::Zero(padded.size());
  weights(0) = 1.0L;
  std::ranges::copy(beta, weights.begin() + 1);
  return innovation_variance() * static_cast<double>(weights.dot(u.covariance() * weights));
}

std::optional<double> ArmaGarch::nearest_root_pair() const {
  if (alpha.empty() || beta.empty()) return {};
  const Eigen::VectorXcd poles = characteristic_roots(alpha, 1.0);
  const Eigen::VectorXcd zeros = characteristic_roots(beta, -1.0);
  double nearest = std::abs(poles(0) - zeros(0));
  for (const auto& pole : poles)
    for (const auto& zero : zeros) nearest = std::min(nearest, std::abs(pole - zero));
  return nearest;
}

std::vector<std::string> arma_garch_names(const ArmaGarchOrders& orders, bool constant) {
  std::vector<std::string> names;
  const auto numbered = [&](const char* name, int count) {
    for (int i = 1; i <= count; ++i) names.push_back(fmt::format("{}{}", name, i));
  };
  if (constant) names.emplace_back("nu");
  numbered("alpha", orders.ar);
  numbered("beta", orders.ma);
  names.emplace_back("gamma0");
  numbered("gamma", orders.arch);
  numbered("delta", orders.garch);
  return names;
}

VectorXd arma_garch_vector(const ArmaGarch& model, bool constant) {
  std::vector<double> theta;
  const auto append = [&](const std::vector<double>& values) { theta.insert(theta.end(), values.begin(), values.end()); };
  if (constant) theta.push_back(model.nu);
  append(model.alpha);
  append(model.beta);
  theta.push_back(model.gamma0);
  append(model.gamma);
  append(model.delta);
  return Eigen::Map<const VectorXd>(theta.data(), std::ssize(theta));
}

ArmaGarch arma_garch_model(const ArmaGarchOrders& orders, bool constant, const VectorXd& theta) {
  check_arma_garch(orders);
  const Index expected = (constant ? 1 : 0) + orders.ar + orders.ma + 1 + orders.arch + orders.garch;
  if (theta.size() != expected)
    throw std::invalid_argument(fmt::format("arma_garch_model: {} parameters, {} expected", theta.size(), expected));
  const double* next = theta.data();
  const auto take = [&](int count) {
    const double* from = next;
    next += count;
    return std::vector<double>(from, next);
  };
  ArmaGarch model;
  if (constant) model.nu = *next++;
  model.alpha = take(orders.ar);
  model.beta = take(orders.ma);
  model.gamma0 = *next++;
  model.gamma = take(orders.arch);
  model.delta = take(orders.garch);
  return model;
}

}  // namespace coast::noise
