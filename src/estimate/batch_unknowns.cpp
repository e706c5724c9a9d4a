#include "batch_unknowns.hpp"

namespace coast::estimate {

BatchUnknowns::BatchUnknowns(const StateLayout& layout, const Eigen::MatrixXd& P) : layout_(layout), blocks_(layout) {
  for (int i = 0; i < kNav; ++i) at_knots_.push_back(i);
  constexpr double kAnyInterval = 1.0;  // s
  blocks_.over(kAnyInterval);
  layout.for_each_block([&](const StateLayout::Block& block) {
    const bool driven = !blocks_.driving_noise(block).isZero(0.0);
    for (int i = 0; i < block.size; ++i) (driven ? at_knots_ : once_).push_back(block.offset + i);
  });
  for (const int i : once_)
    if (P(i, i) > 0.0) unknown_once_.push_back(i);
  constant_ = false;
  const Eigen::MatrixXd after = moved(kAnyInterval);
  constant_ = true;
  constant_ = after == moved(kAnyInterval);
}

Eigen::MatrixXd BatchUnknowns::moved(double elapsed) {
  const int rest = layout_.size() - kNav;
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(rest, rest);
  if (!constant_ && elapsed > 0.0) blocks_.over(elapsed).apply(all);
  Eigen::MatrixXd mine(once_.size(), unknown_once_.size());
  for (std::size_t i = 0; i < once_.size(); ++i)
    for (std::size_t j = 0; j < unknown_once_.size(); ++j)
      mine(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = all(once_[i] - kNav, unknown_once_[j] - kNav);
  return mine;
}

}  // namespace coast::estimate
