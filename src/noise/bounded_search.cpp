#include "bounded_search.hpp"

#include <LBFGSB.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coast::noise {

SearchResult search_within(const std::vector<double>& start, const std::vector<Interval>& box, double gradient_tolerance,
                           int iterations, const std::function<double(const std::vector<double>&, Eigen::VectorXd&)>& cost) {
  const auto n = static_cast<Eigen::Index>(start.size());
  Eigen::VectorXd lower(n);
  Eigen::VectorXd upper(n);
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    lower(i) = box[at].lower;
    upper(i) = box[at].upper;
    x(i) = std::clamp(start[at], box[at].lower, box[at].upper);
  }
  SearchResult best{{x.begin(), x.end()}, std::numeric_limits<double>::infinity(), 0, {}};
  const auto evaluate = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
    const std::vector<double> u(at.begin(), at.end());
    double value = cost(u, gradient);
    ++best.evaluations;
    if (!std::isfinite(value)) {
      value = 1e300;
      gradient.setZero();
    }
    if (value < best.value) {
      best.value = value;
      best.u = u;
    }
    best.trace.push_back(best.value);
    return value;
  };
  LBFGSpp::LBFGSBParam<double> param;
  param.epsilon = gradient_tolerance;
  param.epsilon_rel = 0.0;
  param.past = 2;
  param.delta = 1e-13;
  param.max_iterations = iterations;
  param.max_linesearch = 30;
  LBFGSpp::LBFGSBSolver<double> solver(param);
  double value = 0.0;
  try {
    solver.minimize(evaluate, x, value, lower, upper);
  } catch (const std::exception&) {  // LBFGSpp throws when its line search fails; the best point so far is in `best`
  }
  return best;
}

}  // namespace coast::noise
