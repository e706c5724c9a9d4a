#include "coast/carrier/relative_state.hpp"

#include <algorithm>
#include <utility>

namespace coast::carrier {

RelativeState::RelativeState() : x(Eigen::VectorXd::Zero(3)), P(Eigen::MatrixXd::Zero(3, 3)), unknowns_(3) {}

RelativeState::RelativeState(const std::vector<Unknown>& named, Eigen::VectorXd mean, Eigen::MatrixXd covariance)
    : x(std::move(mean)), P(std::move(covariance)), unknowns_(3) {
  unknowns_.insert(unknowns_.end(), named.begin(), named.end());
}

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
  note(i, 0.0, value, variance);
}

void RelativeState::evolve(Eigen::Index i, double factor, double added) {
  x(i) *= factor;
  P.row(i) *= factor;
  P.col(i) *= factor;
  P(i, i) += added;
  note(i, factor, 0.0, added);
}

std::vector<StateChange> RelativeState::take_changes() {
  return std::exchange(changes_, {});
}

void RelativeState::note(Eigen::Index i, double factor, double value, double added) {
  const Unknown& unknown = unknowns_[static_cast<std::size_t>(i)];
  if (unknown.kind != Unknown::Kind::kPosition) changes_.push_back({unknown, factor, value, added});
}

void RelativeState::keep(const std::vector<Eigen::Index>& kept) {
  if (static_cast<Eigen::Index>(kept.size()) == size()) return;
  for (Eigen::Index i = 0; i < size(); ++i)
    if (!std::ranges::binary_search(kept, i)) changes_.push_back({unknowns_[static_cast<std::size_t>(i)], 0.0, 0.0, 0.0, true});
  std::vector<Unknown> unknowns;
  for (const Eigen::Index i : kept) unknowns.push_back(unknowns_[static_cast<std::size_t>(i)]);
  const Eigen::VectorXd x_kept = x(kept);
  const Eigen::MatrixXd P_kept = P(kept, kept);
  unknowns_ = std::move(unknowns);
  x = x_kept;
  P = P_kept;
}

}  // namespace coast::carrier
