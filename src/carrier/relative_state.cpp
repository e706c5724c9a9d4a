#include "relative_state.hpp"

#include <algorithm>

namespace coast::carrier {

RelativeState::RelativeState() : x(Eigen::VectorXd::Zero(3)), P(Eigen::MatrixXd::Zero(3, 3)), unknowns_(3) {}

Eigen::Index RelativeState::index(const Unknown& unknown) const {
  const auto found = std::ranges::find(unknowns_, unknown);
  return found == unknowns_.end() ? -1 : found - unknowns_.begin();
}

Eigen::Index RelativeState::add(const Unknown& unknown, double value, double variance) {
  const Eigen::Index i = size();
  unknowns_.push_back(unknown);
  x.conservativeResize(i + 1);
  P.conservativeResize(i + 1, i + 1);
  reset(i, value, variance);
  return i;
}

void RelativeState::reset(Eigen::Index i, double value, double variance) {
  x(i) = value;
  P.row(i).setZero();
  P.col(i).setZero();
  P(i, i) = variance;
}

void RelativeState::keep(const std::vector<Eigen::Index>& kept) {
  if (static_cast<Eigen::Index>(kept.size()) == size()) return;
  std::vector<Unknown> unknowns;
  for (const Eigen::Index i : kept) unknowns.push_back(unknowns_[static_cast<std::size_t>(i)]);
  const Eigen::VectorXd x_kept = x(kept);
  const Eigen::MatrixXd P_kept = P(kept, kept);
  unknowns_ = std::move(unknowns);
  x = x_kept;
  P = P_kept;
}

}  // namespace coast::carrier
