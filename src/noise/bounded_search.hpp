#pragma once
// L-BFGS-B within a box, over LBFGSpp. Private to the room.

#include <LBFGSB.h>

#include <span>
#include <vector>

#include "coast/noise/interval.hpp"

namespace coast::noise {

struct SearchResult {
  std::vector<double> u;
  double value = 0.0;
  int evaluations = 0;
  std::vector<double> trace = {};  ///< the best value after each evaluation
};

/// Minimises `cost(u, gradient)`; variables whose range is a point stay. Ends where the projected gradient is below
/// `gradient_tolerance` or a step gains nothing; a line search that finds no better point ends it too: the best point counts.
template <class Cost>
SearchResult search_within(const std::vector<double>& start, const std::vector<Interval>& box, double gradient_tolerance,
                           int iterations, Cost&& cost) {
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
  } catch (const std::exception&) {  // LBFGSpp throws where its line search ends; what it has found is in `best`
  }
  return best;
}

}  // namespace coast::noise
