#include "parity_blocks.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace coast::array {

namespace {

using Regressors = Eigen::Matrix<double, 4, 1>;

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

/// Roughness from the median over the sensors of each difference: a burst in one sensor is not motion.
void motion_power(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, ParityBlocks& blocks) {
  const auto count = static_cast<Eigen::Index>(blocks.count);
  blocks.power.setZero(2, count);
  blocks.roughness.setZero(2, count);
  std::vector<double> changes;
  for (Eigen::Index b = 0; b < count; ++b) {
    for (int c = 0; c < kChannels; ++c) {
      double squares = 0.0;
      for (std::size_t i = 0; i < blocks.length; ++i) {
        const std::size_t n = static_cast<std::size_t>(b) * blocks.length + i;
        if (n == 0) continue;
        changes.clear();
        for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
          const auto& values = signals.sensors[k].values;
          if (((present[k][n] & present[k][n - 1]) >> c & 1) != 0)
            changes.push_back(values(c, static_cast<Eigen::Index>(n)) - values(c, static_cast<Eigen::Index>(n) - 1));
        }
        const double change = median_of(changes);
        squares += change * change;
      }
      blocks.roughness(c / 3, b) += squares / static_cast<double>(blocks.length);
    }
  }
  std::array<Eigen::VectorXd, 2> centre;
  for (int group = 0; group < 2; ++group)
    centre.at(static_cast<std::size_t>(group)) = blocks.common.middleRows(3 * group, 3).rowwise().mean();
  for (Eigen::Index b = 0; b < count; ++b) {
    for (int group = 0; group < 2; ++group) {
      const Eigen::Vector3d now = blocks.common.block<3, 1>(3 * group, b);
      const Eigen::Vector3d before = blocks.common.block<3, 1>(3 * group, std::max<Eigen::Index>(b - 1, 0));
      blocks.power(group, b) = (now - centre.at(static_cast<std::size_t>(group))).squaredNorm() + (now - before).squaredNorm() +
                               blocks.roughness(group, b);
    }
  }
}

/// Motion about its mean over the record, and the channel's own rate of change per block.
Regressors regressors_at(const ParityBlocks& blocks, const Eigen::VectorXd& centre, int channel, Eigen::Index b) {
  const int group = channel / 3 * 3;
  const Eigen::Index before = std::max<Eigen::Index>(b - 1, 0);
  const Eigen::Index after = std::min<Eigen::Index>(b + 1, blocks.common.cols() - 1);
  Regressors x;
  x.head<3>() = blocks.common.block<3, 1>(group, b) - centre.segment<3>(group);
  x(3) = (blocks.common(channel, after) - blocks.common(channel, before)) / 2.0;
  return x;
}

struct ResponseData {
  Eigen::Matrix4Xd x;
  Eigen::VectorXd y;
};

/// Differences over five seconds: biases cancel, slow motion remains.
ResponseData response_data(const ParityBlocks& blocks, const Eigen::VectorXd& centre, std::size_t sensor, int channel) {
  constexpr Eigen::Index kLag = 50;
  const auto count = static_cast<Eigen::Index>(blocks.count);
  ResponseData data{Eigen::Matrix4Xd::Zero(4, count), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index b = kLag; b < count; ++b) {
    if (!blocks.has(sensor, channel, static_cast<std::size_t>(b)) ||
        !blocks.has(sensor, channel, static_cast<std::size_t>(b - kLag)))
      continue;
    data.x.col(b) = regressors_at(blocks, centre, channel, b) - regressors_at(blocks, centre, channel, b - kLag);
    const auto residual = [&](Eigen::Index at) { return blocks.means[sensor](channel, at) - blocks.common(channel, at); };
    data.y(b) = residual(b) - residual(b - kLag);
  }
  return data;
}

/// Least absolute deviations by reweighting, then bisquare: the first finds the majority, the second rejects the rest.
Regressors robust_response(const ResponseData& data) {
  constexpr int kRounds = 12;
  constexpr double kCutoff = 4.685;  // 95 % efficient for normal errors (Beaton & Tukey 1974)
  Regressors g = Regressors::Zero();
  std::vector<double> sizes;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd left = data.y - data.x.transpose() * g;
    sizes.clear();
    for (const double value : left)
      if (value != 0.0) sizes.push_back(std::abs(value));
    const double scale = median_of(sizes) / 0.6745;
    if (scale == 0.0) return g;
    Eigen::VectorXd weight(left.size());
    for (Eigen::Index b = 0; b < left.size(); ++b) {
      const double u = std::abs(left(b)) / scale;
      weight(b) = round < kRounds / 2 ? 1.0 / std::max(u, 0.1)
                  : u < kCutoff       ? std::pow(1.0 - u * u / (kCutoff * kCutoff), 2)
                                      : 0.0;
    }
    Eigen::Matrix4d A = data.x * weight.asDiagonal() * data.x.transpose();
    // Prior sigma of 0.1 on each coefficient: without motion the estimate is zero.
    A.diagonal().array() += scale * scale / 0.01;
    g = A.ldlt().solve(data.x * weight.cwiseProduct(data.y));
  }
  return g;
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

void remove_constant_response(ParityBlocks& blocks) {
  const Eigen::VectorXd centre = blocks.common.rowwise().mean();
  for (std::size_t k = 0; k < blocks.means.size(); ++k) {
    for (int c = 0; c < kChannels; ++c) {
      const Regressors g = robust_response(response_data(blocks, centre, k, c));
      for (Eigen::Index b = 0; b < blocks.means[k].cols(); ++b)
        blocks.means[k](c, b) -= g.dot(regressors_at(blocks, centre, c, b));
    }
  }
}

}  // namespace coast::array
