#include "coast/array/channel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "residuals.hpp"

namespace coast::array {

namespace {

/// Sample blocks of about equal length that cover all samples.
struct Blocking {
  std::size_t length = 1;
  std::size_t count = 1;
  std::size_t samples = 0;

  Blocking(std::size_t all, double window, double dt) : samples(all) {
    length = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(window / dt)), 1, std::max<std::size_t>(all, 1));
    count = std::max<std::size_t>(1, all / length);
  }
  [[nodiscard]] std::size_t first(std::size_t block) const { return block * length; }
  [[nodiscard]] std::size_t end(std::size_t block) const { return block + 1 == count ? samples : (block + 1) * length; }
};

/// For one block; a sensor without samples in it has no offset.
struct BlockOffsets {
  Eigen::VectorXd offset;
  Eigen::Array<bool, Eigen::Dynamic, 1> present;
};

/// Offsets of the sensors about their mean in one block, by least squares: z_k[n] = common[n] + b_k, sum b_k = 0. Availability
/// varies, so the mean of the available sensors is corrected for their mean bias, iterated to convergence.
BlockOffsets offsets_in_block(const Signals& signals, int channel, std::size_t from, std::size_t to) {
  constexpr int kSweeps = 6;
  const std::size_t sensors = signals.sensors.size();
  BlockOffsets block{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sensors)), {}};
  Eigen::VectorXd& offset = block.offset;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(offset.size());
    Eigen::VectorXd count = Eigen::VectorXd::Zero(offset.size());
    for (std::size_t n = from; n < to; ++n) {
      double common = 0.0;
      int present = 0;
      for (std::size_t k = 0; k < sensors; ++k) {
        if (!signals.sensors[k].may_use(channel, n)) continue;
        common += signals.sensors[k].values(channel, static_cast<Eigen::Index>(n)) - offset(static_cast<Eigen::Index>(k));
        ++present;
      }
      if (present < 2) continue;
      common /= present;
      for (std::size_t k = 0; k < sensors; ++k) {
        if (!signals.sensors[k].may_use(channel, n)) continue;
        sum(static_cast<Eigen::Index>(k)) += signals.sensors[k].values(channel, static_cast<Eigen::Index>(n)) - common;
        count(static_cast<Eigen::Index>(k)) += 1.0;
      }
    }
    const Eigen::VectorXd before = offset;
    for (Eigen::Index k = 0; k < offset.size(); ++k)
      if (count(k) > 0.0) offset(k) = sum(k) / count(k);
    offset.array() -= offset.mean();
    block.present = count.array() > 0.0;
    if ((offset - before).cwiseAbs().maxCoeff() <= 1e-12 * (1.0 + offset.cwiseAbs().maxCoeff())) break;
  }
  return block;
}

/// A sensor without samples in a block has the offset of a neighbouring block, relative to the sensors in this block: the level
/// of the corrected signals remains that of all sensors while one is missing. A block in which no two are available at once
/// has the offsets of the neighbour.
void fill_from(const BlockOffsets& neighbour, BlockOffsets& block) {
  if (block.present.all()) return;
  if (!block.present.any()) {
    block = neighbour;
    return;
  }
  const Eigen::Array<bool, Eigen::Dynamic, 1> both = block.present && neighbour.present;
  if (!both.any()) return;
  const double shift = both.select((block.offset - neighbour.offset).array(), 0.0).sum() / static_cast<double>(both.count());
  for (Eigen::Index k = 0; k < block.offset.size(); ++k)
    if (!block.present(k) && neighbour.present(k)) {
      block.offset(k) = neighbour.offset(k) + shift;
      block.present(k) = true;
    }
  block.offset.array() -= block.offset.mean();
}

/// Linear between the middles of the blocks, constant before the first and after the last.
double between_blocks(const Eigen::Ref<const Eigen::RowVectorXd>& at_middles, double block) {
  const Eigen::Index last = at_middles.size() - 1;
  if (block <= 0.0) return at_middles(0);
  if (block >= static_cast<double>(last)) return at_middles(last);
  const auto left = static_cast<Eigen::Index>(block);
  const double share = block - static_cast<double>(left);
  return (1.0 - share) * at_middles(left) + share * at_middles(left + 1);
}

/// Residual variances of one block about their own mean, and which sensors have enough samples.
struct BlockVariances {
  std::vector<std::size_t> sensors;
  std::vector<double> variances;
};

BlockVariances block_variances(const Signals& signals, const Eigen::MatrixXd& y, int channel, std::size_t from,
                               std::size_t to) {
  BlockVariances result;
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t n = from; n < to; ++n) {
      if (!signals.sensors[k].may_use(channel, n)) continue;
      const double value = y(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(n));
      sum += value;
      squares += value * value;
      count += 1.0;
    }
    if (count < 2.0 || 2.0 * count < static_cast<double>(to - from)) continue;
    result.sensors.push_back(k);
    result.variances.push_back(std::max(0.0, (squares - sum * sum / count) / (count - 1.0)));
  }
  return result;
}

/// Sum of the known (not negative) values of a row or column over that of their weights; 1 if none is known.
template <class Values, class Weights>
double known_over(const Values& values, const Weights& weights) {
  double sum = 0.0, weight = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values(i) < 0.0) continue;
    sum += values(i);
    weight += weights(i);
  }
  return weight > 0.0 ? sum / weight : 1.0;
}

/// A variance that is not known (negative) is the size of its sensor times the level of its block. Both follow from the known
/// ones, each in turn: a sensor that is missing while all are shaken is not thought quiet.
void fill_missing(Eigen::MatrixXd& variance) {
  constexpr int kRounds = 20;
  if ((variance.array() >= 0.0).all()) return;
  Eigen::VectorXd size(variance.rows()), level = Eigen::VectorXd::Ones(variance.cols());
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index k = 0; k < variance.rows(); ++k) size(k) = known_over(variance.row(k), level);
    for (Eigen::Index b = 0; b < variance.cols(); ++b) level(b) = known_over(variance.col(b), size);
  }
  for (Eigen::Index b = 0; b < variance.cols(); ++b)
    for (Eigen::Index k = 0; k < variance.rows(); ++k)
      if (variance(k, b) < 0.0) variance(k, b) = size(k) * level(b);
}

}  // namespace

std::vector<double> own_variances(std::span<const double> residual_variances) {
  if (residual_variances.size() < 2)
    throw std::invalid_argument(fmt::format("own_variances: {} sensors, at least 2", residual_variances.size()));
  std::vector<double> own(residual_variances.begin(), residual_variances.end());
  solve_own_variances(own);
  return own;
}

std::vector<Eigen::Matrix<double, kChannels, Eigen::Dynamic>> take_off_relative_offsets(Signals& signals, double window_s) {
  const Blocking blocks(signals.samples(), window_s, signals.dt);
  const std::size_t sensors = signals.sensors.size();
  std::vector<Eigen::Matrix<double, kChannels, Eigen::Dynamic>> offsets(sensors);
  for (auto& own : offsets) own.resize(kChannels, static_cast<Eigen::Index>(blocks.count));
  for (int c = 0; c < kChannels; ++c) {
    std::vector<BlockOffsets> found;
    for (std::size_t b = 0; b < blocks.count; ++b) {
      found.push_back(offsets_in_block(signals, c, blocks.first(b), blocks.end(b)));
      if (b > 0) fill_from(found[b - 1], found[b]);
    }
    for (std::size_t b = blocks.count - 1; b-- > 0;) fill_from(found[b + 1], found[b]);
    for (std::size_t b = 0; b < blocks.count; ++b)
      for (std::size_t k = 0; k < sensors; ++k)
        offsets[k](c, static_cast<Eigen::Index>(b)) = found[b].offset(static_cast<Eigen::Index>(k));
    for (std::size_t k = 0; k < sensors; ++k)
      for (std::size_t n = 0; n < signals.samples(); ++n)
        signals.sensors[k].values(c, static_cast<Eigen::Index>(n)) -=
            between_blocks(offsets[k].row(c), (static_cast<double>(n) + 0.5) / static_cast<double>(blocks.length) - 0.5);
  }
  return offsets;
}

Eigen::MatrixXd residuals(const Signals& signals, int channel) {
  const auto samples = static_cast<Eigen::Index>(signals.samples());
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(signals.sensors.size()), samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const double mean = plain_mean(signals, channel, static_cast<std::size_t>(n));
    for (std::size_t k = 0; k < signals.sensors.size(); ++k)
      if (signals.sensors[k].may_use(channel, static_cast<std::size_t>(n)))
        y(static_cast<Eigen::Index>(k), n) = signals.sensors[k].values(channel, n) - mean;
  }
  return y;
}

NoiseOverTime noise_over_time(const Signals& signals, int channel, double window_s) {
  const Blocking blocks(signals.samples(), window_s, signals.dt);
  const Eigen::MatrixXd y = residuals(signals, channel);
  NoiseOverTime noise;
  noise.block = blocks.length;
  noise.variance = Eigen::MatrixXd::Constant(y.rows(), static_cast<Eigen::Index>(blocks.count), -1.0);
  for (std::size_t b = 0; b < blocks.count; ++b) {
    const BlockVariances found = block_variances(signals, y, channel, blocks.first(b), blocks.end(b));
    if (found.sensors.size() < 2) continue;
    const std::vector<double> own = own_variances(found.variances);
    for (std::size_t i = 0; i < own.size(); ++i)
      noise.variance(static_cast<Eigen::Index>(found.sensors[i]), static_cast<Eigen::Index>(b)) = own[i];
  }
  fill_missing(noise.variance);
  return noise;
}

}  // namespace coast::array
