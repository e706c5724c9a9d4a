#include "gyro_start.hpp"

#include <Eigen/Cholesky>
#include <vector>

namespace coast::study {

void set_gyro_bias(const estimate::StateLayout& layout, Eigen::Vector3d bias_b, estimate::FilterState& state) {
  using Block = estimate::StateLayout::SensorBlock;
  const std::size_t members = std::max<std::size_t>(1, layout.members().size());
  std::vector<std::vector<const Block*>> widest(3, std::vector<const Block*>(members, nullptr));
  const auto prior = [&](const Block* block) { return state.P(block->offset, block->offset); };
  for (const Block& block : layout.sensors()) {
    if (block.sensor != noise::Sensor::kGyro || block.signal_b) continue;
    bias_b -= block.output.dot(state.x.segment(block.offset, block.size)) * block.response_b;
    if (block.size != 1) continue;
    Eigen::Index axis = 0;
    block.response_b.cwiseAbs().maxCoeff(&axis);
    const Block*& slot = widest[static_cast<std::size_t>(axis)][block.member.value_or(0)];
    if (slot == nullptr || prior(&block) > prior(slot)) slot = &block;
  }
  for (const std::vector<const Block*>& axis : widest) {
    double variance = 0.0;  // of the sum of the states' outputs
    for (const Block* block : axis)
      if (block != nullptr) variance += block->output(0) * block->output(0) * prior(block);
    if (!(variance > 0.0)) continue;
    for (const Block* block : axis)
      if (block != nullptr) state.x(block->offset) = prior(block) * block->output(0) / variance * block->response_b.dot(bias_b);
  }
}

void know_gyro_bias(const estimate::StateLayout& layout, double sd, Eigen::MatrixXd& P) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, layout.size());
  for (const estimate::StateLayout::SensorBlock& block : layout.sensors())
    if (block.sensor == noise::Sensor::kGyro && !block.signal_b)
      H.middleCols(block.offset, block.size) += block.response_b * block.output;
  const Eigen::MatrixXd PHt = P * H.transpose();
  const Eigen::Matrix3d S = H * PHt + sd * sd * Eigen::Matrix3d::Identity();
  P -= PHt * S.llt().solve(PHt.transpose());
  P = 0.5 * (P + P.transpose()).eval();
}

}  // namespace coast::study
