#include "coast/fleet/random_effects.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coast/fleet/student.hpp"

namespace coast::fleet {

namespace {

double restricted(const std::vector<Observations>& units, const Scatter& scatter) {
  double sum = 0.0;
  for (const Observations& unit : units) sum += restricted_log_likelihood(unit, scatter);
  return sum;
}

/// Maximum of f over [0, high]: the best of a grid that is dense towards 0, then golden section about it. The restricted
/// likelihood may have a second maximum at 0, which the grid includes.
template <class Function>
double maximise(Function f, double high) {
  constexpr int kGrid = 24;
  constexpr double kTolerance = 1e-9;  // below it rounding of the likelihood decides
  const auto at = [&](int i) { return high * std::pow(static_cast<double>(i) / kGrid, 3.0); };
  int best = 0;
  double best_value = f(0.0);
  for (int i = 1; i <= kGrid; ++i)
    if (const double value = f(at(i)); value > best_value) best = i, best_value = value;
  double low = at(std::max(best - 1, 0));
  double top = at(std::min(best + 1, kGrid));
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = top - golden * (top - low);
  double b = low + golden * (top - low);
  double f_a = f(a);
  double f_b = f(b);
  while (top - low > kTolerance * high) {
    if (f_a > f_b) {
      top = b;
      b = a, f_b = f_a;
      a = top - golden * (top - low), f_a = f(a);
    } else {
      low = a;
      a = b, f_a = f_b;
      b = low + golden * (top - low), f_b = f(b);
    }
  }
  const double found = 0.5 * (low + top);
  return f(found) > best_value ? found : at(best);
}

double spread(const Observations& o) {
  return o.y.maxCoeff() - o.y.minCoeff();
}

/// Where the profile falls below its 95 % bound, between a point inside and one outside.
template <class Function>
double crossing(Function inside, double in, double out) {
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (in + out);
    (inside(middle) ? in : out) = middle;
  }
  return in;
}

}  // namespace

Eigen::MatrixXd scatter_factor(const Eigen::VectorXd& sigma, const Eigen::VectorXd& t, const Scatter& scatter) {
  const Eigen::VectorXd variance = sigma.array().square() + scatter.tau * scatter.tau;
  if (scatter.walk == 0.0) return variance.cwiseSqrt().asDiagonal();
  Eigen::MatrixXd V = variance.asDiagonal();
  for (Eigen::Index i = 0; i < t.size(); ++i)
    for (Eigen::Index j = 0; j < t.size(); ++j) V(i, j) += scatter.walk * scatter.walk * (std::min(t[i], t[j]) - t[0]);
  return V.llt().matrixL();
}

LeastSquares least_squares(const Observations& o, const Scatter& scatter) {
  const Eigen::MatrixXd L = scatter_factor(o.sigma, o.t, scatter);
  const auto lower = L.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd X = lower.solve(o.X);
  const Eigen::VectorXd y = lower.solve(o.y);
  const Eigen::LLT<Eigen::MatrixXd> normal(X.transpose() * X);
  LeastSquares s;
  s.beta = normal.solve(X.transpose() * y);
  s.covariance = normal.solve(Eigen::MatrixXd::Identity(X.cols(), X.cols()));
  const Eigen::MatrixXd factor = normal.matrixL();
  s.log_det = 2.0 * (L.diagonal().array().log().sum() + factor.diagonal().array().log().sum());
  s.chi_square = (y - X * s.beta).squaredNorm();
  return s;
}

double restricted_log_likelihood(const Observations& observations, const Scatter& scatter) {
  const LeastSquares s = least_squares(observations, scatter);
  return -0.5 * (s.log_det + s.chi_square);
}

std::pair<double, double> RandomEffects::interval_95(Eigen::Index unknown) const {
  const double factor = student_two_sided_quantile(0.05, dof > 0 ? dof : HUGE_VAL);
  return {beta[unknown] - factor * sd(unknown), beta[unknown] + factor * sd(unknown)};
}

double RandomEffects::sd(Eigen::Index unknown) const {
  return std::sqrt(covariance(unknown, unknown));
}

RandomEffects random_effects(const Observations& o) {
  constexpr double kChi95 = 3.841458820694124;
  if (o.y.size() < o.X.cols()) throw std::invalid_argument("random_effects: fewer values than unknowns");
  RandomEffects result;
  const auto likelihood = [&](double tau) { return restricted_log_likelihood(o, {tau, 0.0}); };
  const int dof = static_cast<int>(o.y.size() - o.X.cols());
  double factor = 1.0;
  if (dof >= 1 && spread(o) > 0.0) {
    const double high = 2.0 * spread(o);
    result.dof = dof;
    result.scatter.tau = maximise(likelihood, high);
    const double best = likelihood(result.scatter.tau);
    const auto inside = [&](double tau) { return 2.0 * (best - likelihood(tau)) <= kChi95; };
    double outside = std::max(high, result.scatter.tau);
    while (inside(outside) && outside < 1e3 * high) outside *= 2.0;
    result.tau_95 = {inside(0.0) ? 0.0 : crossing(inside, result.scatter.tau, 0.0),
                     crossing(inside, result.scatter.tau, outside)};
  }
  const LeastSquares s = least_squares(o, result.scatter);
  if (result.dof > 0) factor = s.chi_square / result.dof;
  result.beta = s.beta;
  result.covariance = factor * s.covariance;
  return result;
}

Scatter panel_scatter(const std::vector<Observations>& units, bool with_walk) {
  double high = 0.0;
  double years = 0.0;
  for (const Observations& unit : units) {
    high = std::max(high, spread(unit));
    years = std::max(years, unit.t[unit.t.size() - 1] - unit.t[0]);
  }
  Scatter scatter;
  if (high == 0.0) return scatter;
  const auto best_tau = [&](double walk) { return maximise([&](double tau) { return restricted(units, {tau, walk}); }, high); };
  if (!with_walk || years <= 0.0) return {best_tau(0.0), 0.0};
  scatter.tau = best_tau(0.0);
  for (int sweep = 0; sweep < 6; ++sweep) {  // one after the other: each sweep gains
    const Scatter before = scatter;
    scatter.walk = maximise([&](double walk) { return restricted(units, {scatter.tau, walk}); }, 2.0 * high / std::sqrt(years));
    scatter.tau = best_tau(scatter.walk);
    if (std::abs(scatter.tau - before.tau) + std::abs(scatter.walk - before.walk) < 1e-4 * (scatter.tau + scatter.walk)) break;
  }
  return scatter;
}

}  // namespace coast::fleet
