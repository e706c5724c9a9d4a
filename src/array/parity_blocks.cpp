#include "parity_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

void parity_means(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, ParityBlocks& blocks) {
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    const SensorSignals& sensor = signals.sensors[k];
    auto& mean = blocks.means.emplace_back(Eigen::MatrixXd::Zero(kChannels, static_cast<Eigen::Index>(blocks.count)));
    auto& whole = blocks.whole.emplace_back(blocks.count, kAllUsable);
    for (std::size_t b = 0; b < blocks.count; ++b) {
      for (std::size_t i = 0; i < blocks.length; ++i)
        whole[b] = static_cast<std::uint8_t>(whole[b] & present[k][b * blocks.length + i]);
      const auto part =
          sensor.values.middleCols(static_cast<Eigen::Index>(b * blocks.length), static_cast<Eigen::Index>(blocks.length));
      for (int c = 0; c < kChannels; ++c)
        if (blocks.has(k, c, b)) mean(c, static_cast<Eigen::Index>(b)) = part.row(c).mean();
    }
  }
}

/// Median over the sensors with their biases subtracted; without sensors: the previous value.
void common_of_blocks(ParityBlocks& blocks) {
  std::vector<double> values;
  blocks.common.setZero(kChannels, static_cast<Eigen::Index>(blocks.count));
  for (std::size_t b = 0; b < blocks.count; ++b) {
    const auto column = static_cast<Eigen::Index>(b);
    for (int c = 0; c < kChannels; ++c) {
      values.clear();
      for (std::size_t k = 0; k < blocks.means.size(); ++k)
        if (blocks.has(k, c, b)) values.push_back(blocks.means[k](c, column) - blocks.bias[k](c));
      if (!values.empty())
        blocks.common(c, column) = median_of(values);
      else if (b > 0)
        blocks.common(c, column) = blocks.common(c, column - 1);
    }
  }
}

/// Biases relative to the common signal; their own median over the sensors is the array's zero.
void biases_of_blocks(ParityBlocks& blocks) {
  std::vector<double> values;
  for (int c = 0; c < kChannels; ++c) {
    for (std::size_t k = 0; k < blocks.means.size(); ++k) {
      values.clear();
      for (std::size_t b = 0; b < blocks.count; ++b)
        if (blocks.has(k, c, b))
          values.push_back(blocks.means[k](c, static_cast<Eigen::Index>(b)) - blocks.common(c, static_cast<Eigen::Index>(b)));
      blocks.bias[k](c) = median_of(values);
    }
  }
}

/// Mean square of the common sample-to-sample differences, each the median over the sensors: a burst in one is not motion.
Eigen::Matrix2Xd power_within_blocks(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present,
                                     const ParityBlocks& blocks) {
  Eigen::Matrix2Xd power = Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(blocks.count));
  std::vector<double> changes;
  for (std::size_t n = 1; n < blocks.count * blocks.length; ++n) {
    for (int c = 0; c < kChannels; ++c) {
      changes.clear();
      for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
        const auto& values = signals.sensors[k].values;
        if (((present[k][n] & present[k][n - 1]) >> c & 1) != 0)
          changes.push_back(values(c, static_cast<Eigen::Index>(n)) - values(c, static_cast<Eigen::Index>(n) - 1));
      }
      const double change = median_of(changes);
      power(c / 3, static_cast<Eigen::Index>(n / blocks.length)) += change * change / static_cast<double>(blocks.length);
    }
  }
  return power;
}

void motion_power(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, ParityBlocks& blocks) {
  blocks.power = power_within_blocks(signals, present, blocks);
  for (int group = 0; group < 2; ++group) {
    const Eigen::Vector3d centre = blocks.common.middleRows(3 * group, 3).rowwise().mean();
    for (Eigen::Index b = 0; b < blocks.power.cols(); ++b) {
      const Eigen::Vector3d now = blocks.common.block<3, 1>(3 * group, b);
      const Eigen::Vector3d before = blocks.common.block<3, 1>(3 * group, std::max<Eigen::Index>(b - 1, 0));
      blocks.power(group, b) += (now - centre).squaredNorm() + (now - before).squaredNorm();
    }
  }
}

}  // namespace

double median_of(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2.0;
}

ParityBlocks make_blocks(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present) {
  ParityBlocks blocks;
  blocks.length = static_cast<std::size_t>(std::max(4.0, std::round(kBlock / signals.dt)));
  blocks.count = signals.samples() / blocks.length;
  blocks.seconds = static_cast<double>(blocks.length) * signals.dt;
  blocks.bias.assign(signals.sensors.size(), Channels::Zero());
  parity_means(signals, present, blocks);
  // Medians of sensors with biases jump between sensors: the second iteration has the biases subtracted.
  for (int round = 0; round < 2; ++round) {
    common_of_blocks(blocks);
    biases_of_blocks(blocks);
  }
  common_of_blocks(blocks);
  motion_power(signals, present, blocks);
  return blocks;
}

}  // namespace coast::array
