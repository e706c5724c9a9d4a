#include "arma_garch_coordinates.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/partial_autocorrelation.hpp"

namespace coast::noise {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

double logistic(double u) {
  return 1.0 / (1.0 + std::exp(-u));
}

/// atanh of the partial autocorrelations of coefficients, whose roots are equally damped until the autocorrelations exist.
VectorXd unbounded_partials(VectorXd a) {
  constexpr double kDamped = 0.98;
  constexpr double kMostTanh = 0.9999;
  while (true) {
    const auto partial = partial_autocorrelations({a.data(), static_cast<std::size_t>(a.size())});
    if (partial && std::ranges::all_of(*partial, [](double p) { return std::abs(p) < kMostTanh; })) {
      VectorXd u(a.size());
      for (Index i = 0; i < a.size(); ++i) u(i) = std::atanh((*partial)[static_cast<std::size_t>(i)]);
      return u;
    }
    double factor = 1.0;
    for (double& coefficient : a) coefficient *= factor *= kDamped;
  }
}

}  // namespace

ArCoefficients ar_from_partial(const VectorXd& partial) {
  const Index order = partial.size();
  ArCoefficients now{VectorXd::Zero(order), MatrixXd::Zero(order, order)};
  for (Index k = 0; k < order; ++k) {
    const VectorXd reversed = now.a.head(k).reverse();
    const MatrixXd reversed_slope = now.slope.topRows(k).colwise().reverse();
    now.a.head(k) -= partial(k) * reversed;
    now.slope.topRows(k) -= partial(k) * reversed_slope;
    now.slope.col(k).head(k) -= reversed;
    now.a(k) = partial(k);
    now.slope(k, k) = 1.0;
  }
  return now;
}

VectorXd ArmaGarchCoordinates::shares(const VectorXd& u) const {
  VectorXd logs = VectorXd::Zero(moving());
  logs.head(moving() - 1) = u.segment(layout_.gamma0() + 2, moving() - 1);
  const VectorXd shares = (logs.array() - logs.maxCoeff()).exp();
  return shares / shares.sum();
}

VectorXd ArmaGarchCoordinates::centred(const VectorXd& u) const {
  VectorXd c(layout_.size());
  c(0) = u(0);
  c.segment(layout_.alpha(), layout_.ar) = ar_from_partial(u.segment(layout_.alpha(), layout_.ar).array().tanh()).a;
  c.segment(layout_.beta(), layout_.ma) = -ar_from_partial(u.segment(layout_.beta(), layout_.ma).array().tanh()).a;
  const Index at = layout_.gamma0();
  c(at) = std::exp(u(at));
  if (moving() == 0) return c;
  c(at) *= logistic(-u(at + 1));  // 1 - persistence, without loss of digits
  c.segment(at + 1, moving()) = logistic(u(at + 1)) * shares(u);
  return c;
}

MatrixXd ArmaGarchCoordinates::centred_by_u(const VectorXd& u) const {
  MatrixXd J = MatrixXd::Zero(layout_.size(), layout_.size());
  J(0, 0) = 1.0;
  const auto of_partials = [&](Index from, Index count, double sign) {
    const VectorXd partial = u.segment(from, count).array().tanh();
    const VectorXd by_u = 1.0 - partial.array().square();
    J.block(from, from, count, count) = sign * ar_from_partial(partial).slope * by_u.asDiagonal();
  };
  of_partials(layout_.alpha(), layout_.ar, 1.0);
  of_partials(layout_.beta(), layout_.ma, -1.0);
  const Index at = layout_.gamma0();
  const VectorXd c = centred(u);
  J(at, at) = c(at);
  if (moving() == 0) return J;
  const double persistence = logistic(u(at + 1));
  const VectorXd share = shares(u);
  J(at, at + 1) = -c(at) * persistence;
  J.col(at + 1).segment(at + 1, moving()) = persistence * logistic(-u(at + 1)) * share;
  for (Index i = 0; i + 1 < moving(); ++i) {
    J.col(at + 2 + i).segment(at + 1, moving()) = -persistence * share(i) * share;
    J(at + 1 + i, at + 2 + i) += persistence * share(i);
  }
  return J;
}

VectorXd ArmaGarchCoordinates::inside(const VectorXd& centred) const {
  VectorXd u(layout_.size());
  u(0) = centred(0);
  u.segment(layout_.alpha(), layout_.ar) = unbounded_partials(centred.segment(layout_.alpha(), layout_.ar));
  u.segment(layout_.beta(), layout_.ma) = unbounded_partials(-centred.segment(layout_.beta(), layout_.ma));
  const Index at = layout_.gamma0();
  const VectorXd parts = centred.segment(at + 1, moving()).cwiseMax(1e-6);
  const double persistence = parts.sum();
  u(at) = std::log(centred(at) / (1.0 - persistence));
  if (moving() == 0) return u;
  u(at + 1) = std::log(persistence / (1.0 - persistence));
  const Index last = moving() - 1;
  for (Index i = 0; i < last; ++i) u(at + 2 + i) = std::log(parts(i) / parts(last));
  return u;
}

std::vector<Interval> ArmaGarchCoordinates::box() const {
  constexpr double kLargestMean = 10.0;  // deviations of the series
  constexpr double kLargestAtanh = 7.0;  // a partial autocorrelation 2e-6 from 1
  constexpr double kLargestLog = 14.0;   // persistence 1e-6 from 0 or 1, shares of 1e-6
  std::vector<Interval> all(static_cast<std::size_t>(layout_.size()), {-kLargestLog, kLargestLog});
  const double most = constant_ ? kLargestMean : 0.0;
  all.front() = {-most, most};
  for (Index i = layout_.alpha(); i < layout_.gamma0(); ++i) all[static_cast<std::size_t>(i)] = {-kLargestAtanh, kLargestAtanh};
  return all;
}

}  // namespace coast::noise
