#pragma once
// L-BFGS-B within a box, by LBFGSpp. Private to the room.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "coast/noise/interval.hpp"

namespace coast::noise {

struct SearchResult {
  std::vector<double> u;
  double value = 0.0;
  int evaluations = 0;
  std::vector<double> trace = {};  ///< the best value after each evaluation
};

/// Minimises `cost(u, gradient)`; variables with lower = upper are held. Ends when the projected gradient is below
/// `gradient_tolerance`, a step gains nothing, or a line search finds no better point: the best point is returned.
SearchResult search_within(const std::vector<double>& start, const std::vector<Interval>& box, double gradient_tolerance,
                           int iterations, const std::function<double(const std::vector<double>&, Eigen::VectorXd&)>& cost);

}  // namespace coast::noise
