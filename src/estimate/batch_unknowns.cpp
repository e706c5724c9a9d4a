#include "batch_unknowns.hpp"

namespace coast::estimate {

BatchUnknowns::BatchUnknowns(const StateLayout& layout, const FilterState& start)
    : blocks_(layout), start_(start.x.tail(layout.size() - kNav)) {
  for (int i = 0; i < kNav; ++i) at_knots_.push_back(i);
  constexpr double kAnyInterval = 1.0;  // s
  blocks_.over(kAnyInterval);
  layout.for_each_block([&](const StateLayout::Block& block) {
    const bool driven = !blocks_.driving_noise(block).isZero(0.0);
    for (int i = 0; i < block.size; ++i) (driven ? at_knots_ : once_).push_back(block.offset + i);
  });
  for (const int i : once_)
    if (start.P(i, i) > 0.0) unknown_once_.push_back(i);
  at_start_ = Eigen::MatrixXd::Zero(layout.size(), static_cast<Eigen::Index>(unknown_once_.size()));
  for (Eigen::Index j = 0; j < at_start_.cols(); ++j) {
    const int state = unknown_once_[static_cast<std::size_t>(j)];
    at_start_(state, j) = 1.0;
    const int component = layout.base_offset() ? state - *layout.base_offset() : -1;
    if (component >= 0 && component < 3) at_start_(kPos + component, j) = -1.0;
  }
  const Eigen::MatrixXd after = of_mission(kAnyInterval);
  constant_ = after == at_start_ && prior_mean(kAnyInterval) == prior_mean(0.0);
  of_mission_ = at_start_;
  elapsed_ = 0.0;
}

const Eigen::MatrixXd& BatchUnknowns::of_mission(double elapsed) {
  if (constant_ || elapsed == elapsed_) return of_mission_;
  elapsed_ = elapsed;
  of_mission_ = at_start_;
  if (elapsed > 0.0) blocks_.over(elapsed).apply(of_mission_.bottomRows(start_.size()));
  return of_mission_;
}

Eigen::VectorXd BatchUnknowns::prior_mean(double elapsed) {
  Eigen::MatrixXd x = start_;
  if (!constant_ && elapsed > 0.0) blocks_.over(elapsed).apply(x);
  Eigen::VectorXd mean(once_.size());
  for (std::size_t i = 0; i < once_.size(); ++i) mean(static_cast<Eigen::Index>(i)) = x(once_[i] - kNav);
  return mean;
}

}  // namespace coast::estimate
