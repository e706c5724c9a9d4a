#include "search/movement.hpp"

#include <algorithm>
#include <cmath>

namespace coast::diagnose {

std::vector<Eigen::Index> rows_of(const std::vector<SelectedEffect>& effects, Eigen::Index hypotheses) {
  std::vector<Eigen::Index> rows;
  for (const SelectedEffect& one : effects) rows.push_back(one.from ? hypotheses++ : one.hypothesis);
  return rows;
}

Movement movement(const SizeEvidence& evidence) {
  if (evidence.score.size() == 0) return {};
  const Eigen::MatrixXd covariance = covariance_of(evidence.information);
  return {covariance * evidence.score, covariance.diagonal().cwiseSqrt()};
}

double Movement::farthest() const {
  double most = 0.0;
  for (Eigen::Index i = 0; i < by.size(); ++i)
    if (sd(i) > 0.0) most = std::max(most, std::abs(by(i)) / sd(i));
  return most;
}

Explanation moved(Explanation explanation, const Movement& step, double share) {
  for (std::size_t i = 0; i < explanation.effects.size(); ++i)
    explanation.effects[i].value += share * step.by(static_cast<Eigen::Index>(i));
  return explanation;
}

}  // namespace coast::diagnose
