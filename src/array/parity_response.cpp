#include "parity_response.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

using Regressors = Eigen::Matrix<double, 4, 1>;

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

/// Median over the sensors of each sample, biases subtracted; without sensors: the previous value.
Eigen::MatrixXd common_of_samples(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present,
                                  const ParityBlocks& blocks) {
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(kChannels, static_cast<Eigen::Index>(signals.samples()));
  std::vector<double> values;
  for (Eigen::Index n = 0; n < common.cols(); ++n) {
    for (int c = 0; c < kChannels; ++c) {
      values.clear();
      for (std::size_t k = 0; k < signals.sensors.size(); ++k)
        if (((present[k][static_cast<std::size_t>(n)] >> c) & 1) != 0)
          values.push_back(signals.sensors[k].values(c, n) - blocks.bias[k](c));
      common(c, n) = !values.empty() ? median_of(values) : n > 0 ? common(c, n - 1) : 0.0;
    }
  }
  return common;
}

/// As for blocks; the rate of change is that of a block.
Regressors regressors_of_sample(const Eigen::MatrixXd& common, const Eigen::VectorXd& centre, int channel, Eigen::Index n,
                                double length) {
  const int group = channel / 3 * 3;
  Regressors x;
  x.head<3>() = common.block<3, 1>(group, n) - centre.segment<3>(group);
  x(3) =
      length * (common(channel, std::min(n + 1, common.cols() - 1)) - common(channel, std::max<Eigen::Index>(n - 1, 0))) / 2.0;
  return x;
}

}  // namespace

Signals without_constant_response(Signals signals, const std::vector<std::vector<std::uint8_t>>& present,
                                  const ParityBlocks& blocks) {
  const Eigen::VectorXd centre = blocks.common.rowwise().mean();
  const Eigen::MatrixXd common = common_of_samples(signals, present, blocks);
  const auto length = static_cast<double>(blocks.length);
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    for (int c = 0; c < kChannels; ++c) {
      const Regressors g = robust_response(response_data(blocks, centre, k, c));
      for (Eigen::Index n = 0; n < common.cols(); ++n)
        signals.sensors[k].values(c, n) -= g.dot(regressors_of_sample(common, centre, c, n, length));
    }
  }
  return signals;
}

}  // namespace coast::array
