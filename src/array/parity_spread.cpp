#include "parity_spread.hpp"

#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

/// Distance from the median that half of the values do not exceed (the lower of two: of four values one may lie anywhere);
/// `values` are reordered. Negative: fewer than two values.
double distance_from_median(std::vector<double>& values) {
  if (values.size() < 2) return -1.0;
  const double middle = median_of(values);
  for (double& value : values) value = std::abs(value - middle);
  const auto half = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

/// Sensor k's block means of a channel about their mean over a minute, so that biases that walk do not count.
Eigen::VectorXd about_slow_mean(const ParityBlocks& blocks, std::size_t sensor, int channel) {
  const auto reach = static_cast<Eigen::Index>(std::round(30.0 / blocks.seconds));
  const auto count = static_cast<Eigen::Index>(blocks.count);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count + 1), present = sum, result = Eigen::VectorXd::Zero(count);
  for (Eigen::Index b = 0; b < count; ++b) {
    const bool has = blocks.has(sensor, channel, static_cast<std::size_t>(b));
    result(b) = has ? blocks.means[sensor](channel, b) - blocks.common(channel, b) : 0.0;
    sum(b + 1) = sum(b) + result(b);
    present(b + 1) = present(b) + (has ? 1.0 : 0.0);
  }
  for (Eigen::Index b = 0; b < count; ++b) {
    const Eigen::Index first = std::max<Eigen::Index>(b - reach, 0), end = std::min(b + reach + 1, count);
    result(b) -= (sum(end) - sum(first)) / std::max(1.0, present(end) - present(first));
  }
  return result;
}

/// Squared distances of the means of blocks; negative where they cannot be compared.
Eigen::VectorXd spread_of_means(const ParityBlocks& blocks, int channel) {
  std::vector<Eigen::VectorXd> residuals;
  for (std::size_t k = 0; k < blocks.means.size(); ++k) residuals.push_back(about_slow_mean(blocks, k, channel));
  Eigen::VectorXd result(static_cast<Eigen::Index>(blocks.count));
  std::vector<double> values;
  for (std::size_t b = 0; b < blocks.count; ++b) {
    values.clear();
    for (std::size_t k = 0; k < blocks.means.size(); ++k)
      if (blocks.has(k, channel, b)) values.push_back(residuals[k](static_cast<Eigen::Index>(b)));
    const double distance = distance_from_median(values);
    result(static_cast<Eigen::Index>(b)) = distance < 0.0 ? -1.0 : distance * distance;
  }
  return result;
}

/// Likewise of the samples of a block about its mean, averaged over the block.
Eigen::VectorXd spread_of_samples(const Signals& signals, const ParityBlocks& blocks, int channel) {
  Eigen::VectorXd result = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(blocks.count), -1.0);
  std::vector<double> values;
  for (std::size_t b = 0; b < blocks.count; ++b) {
    const auto column = static_cast<Eigen::Index>(b);
    double squares = 0.0;
    for (std::size_t i = 0; i < blocks.length; ++i) {
      values.clear();
      for (std::size_t k = 0; k < signals.sensors.size(); ++k)
        if (blocks.has(k, channel, b))
          values.push_back(signals.sensors[k].values(channel, static_cast<Eigen::Index>(b * blocks.length + i)) -
                           blocks.means[k](channel, column));
      if (values.size() < 2) break;
      squares += std::pow(distance_from_median(values), 2);
    }
    if (values.size() >= 2) result(column) = squares / static_cast<double>(blocks.length);
  }
  return result;
}

/// Adds a third of the channel's squares over their median to a group's; where there are none the typical value.
void add_relative(const Eigen::VectorXd& squares, Eigen::VectorXd& group) {
  std::vector<double> there;
  for (const double square : squares)
    if (square >= 0.0) there.push_back(square);
  const double typical = median_of(there);
  for (Eigen::Index b = 0; b < squares.size(); ++b)
    group(b) += (squares(b) >= 0.0 && typical > 0.0 ? squares(b) / typical : 1.0) / 3.0;
}

Eigen::VectorXd over_its_median(const Eigen::VectorXd& spread) {
  std::vector<double> values(spread.begin(), spread.end());
  const double typical = median_of(values);
  return typical > 0.0 ? Eigen::VectorXd(spread / typical) : spread;
}

SpreadSeries with_mean_about(const Eigen::VectorXd& squares) {
  constexpr Eigen::Index kReach = 5;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(squares.size() + 1), about = squares;
  for (Eigen::Index b = 0; b < squares.size(); ++b) sum(b + 1) = sum(b) + squares(b);
  for (Eigen::Index b = 0; b < squares.size(); ++b) {
    const Eigen::Index first = std::max<Eigen::Index>(b - kReach, 0), end = std::min(b + kReach + 1, squares.size());
    about(b) = (sum(end) - sum(first)) / static_cast<double>(end - first);
  }
  return {over_its_median(squares), over_its_median(about)};
}

}  // namespace

SensorSpread sensor_spread(const Signals& signals, const ParityBlocks& blocks) {
  SensorSpread spread;
  for (std::size_t group = 0; group < 2; ++group) {
    Eigen::VectorXd means = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(blocks.count)), samples = means;
    for (int axis = 0; axis < 3; ++axis) {
      const int channel = 3 * static_cast<int>(group) + axis;
      add_relative(spread_of_means(blocks, channel), means);
      add_relative(spread_of_samples(signals, blocks, channel), samples);
    }
    spread.of_means.at(group) = with_mean_about(means);
    spread.of_samples.at(group) = with_mean_about(samples);
  }
  return spread;
}

}  // namespace coast::array
