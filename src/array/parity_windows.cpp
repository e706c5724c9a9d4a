#include "parity_windows.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

constexpr std::size_t kStartBlocks = 50;  // first levels: medians over 5 s

Eigen::VectorXd running_sums(const Eigen::VectorXd& values) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(values.size() + 1);
  for (Eigen::Index i = 0; i < values.size(); ++i) sums(i + 1) = sums(i) + values(i);
  return sums;
}

}  // namespace

ChannelWindows::ChannelWindows(const Signals& signals, const ParityBlocks& blocks, const ChannelNoise& noise,
                               const SensorSpread& spread, int channel, double share_per_hour)
    : signals_(signals),
      blocks_(blocks),
      noise_(noise),
      channel_(channel),
      share_per_hour_(share_per_hour),
      sensors_(signals.sensors.size()),
      run_(sensors_, 0),
      valid_run_(sensors_, 0) {
  for (auto& window : level_learnt_) window.resize(sensors_);
  for (auto& window : noise_learnt_) window.resize(sensors_);
  for (auto& window : motion_learnt_) window.resize(sensors_);
  sum_.setZero(at(sensors_), at(blocks.count + 1));
  for (std::size_t k = 0; k < sensors_; ++k)
    for (std::size_t b = 0; b < blocks.count; ++b)
      sum_(at(k), at(b + 1)) = sum_(at(k), at(b)) + blocks.means[k](channel, at(b));
  residual_.setZero(at(sensors_), at(blocks.count));
  variance_ = ratio_ = residual_;
  cross_.assign(sensors_, Eigen::Matrix4Xd::Zero(4, at(blocks.count + 1)));
  motion_sums();
  const auto group = static_cast<std::size_t>(channel / 3);
  spread_of_means_ = {running_sums(spread.of_means.at(group).now), running_sums(spread.of_means.at(group).about)};
  spread_of_samples_ = {running_sums(spread.of_samples.at(group).now), running_sums(spread.of_samples.at(group).about)};
  start_levels();
  set_thresholds();
}

void ChannelWindows::motion_sums() {
  const int group = channel_ / 3;
  const Eigen::Vector3d centre = blocks_.common.middleRows<3>(3 * group).rowwise().mean();
  motion_.setZero(9, at(blocks_.count + 1));
  power_.setZero(at(blocks_.count + 1));
  for (Eigen::Index b = 0; b < at(blocks_.count); ++b) {
    const Eigen::Vector3d x = blocks_.common.block<3, 1>(3 * group, b) - centre;
    Eigen::Matrix<double, 9, 1> terms;
    terms << x, x(0) * x(0), x(0) * x(1), x(0) * x(2), x(1) * x(1), x(1) * x(2), x(2) * x(2);
    motion_.col(b + 1) = motion_.col(b) + terms;
    power_(b + 1) = power_(b) + blocks_.power(group, b);
  }
}

void ChannelWindows::start_levels() {
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
    level_[i].assign(sensors_, 0.0);
    level_uncertainty_[i].assign(sensors_, 0.0);
  }
  std::vector<double> work;
  for (std::size_t k = 0; k < sensors_; ++k) {
    work.clear();
    for (std::size_t b = 0; b < blocks_.count && work.size() < kStartBlocks; ++b)
      if (blocks_.has(k, channel_, b)) work.push_back(blocks_.means[k](channel_, at(b)) - blocks_.common(channel_, at(b)));
    const auto count = static_cast<double>(std::max<std::size_t>(work.size(), 1));
    for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
      level_[i][k] = median_of(work);
      // A median of n values has pi/2 times the variance of their mean.
      level_uncertainty_[i][k] = M_PI / 2.0 * noise_.block_variance(k, 0) / count + noise_.walk_variance(k) * count / 3.0;
    }
  }
}

void ChannelWindows::set_thresholds() {
  constexpr double kShorterTail = 0.85;  // of the degrees of freedom: unequal weights in a sum of squares lengthen its tail
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
    const double u = normal_threshold(share_per_hour_, blocks_.seconds, kLevelWindows[i], true);
    level_threshold_[i] = for_uncertain_scale(u * u, noise_.level_uncertainty());
  }
  for (std::size_t i = 0; i < kNoiseWindows.size(); ++i) {
    noise_threshold_[i].resize(sensors_);
    for (std::size_t k = 0; k < sensors_; ++k) {
      const double nu = kShorterTail * noise_.block_dof(k) * static_cast<double>(kNoiseWindows[i]);
      const double q = chi2_threshold(nu, share_per_hour_, blocks_.seconds, kNoiseWindows[i]);
      noise_threshold_[i][k] = for_uncertain_scale(q, noise_.sample_uncertainty()) / nu;
    }
  }
  for (std::size_t i = 0; i < kMotionWindows.size(); ++i)
    motion_threshold_[i] = for_uncertain_scale(chi2_threshold(3.0, share_per_hour_, blocks_.seconds, kMotionWindows[i]),
                                               noise_.level_uncertainty());
}

/// Variance of a window's mean of sensor k relative to its own past: the past's, the walk since then, the mean's noise.
double ChannelWindows::level_variance(std::size_t k, std::size_t window) const {
  const auto length = static_cast<double>(kLevelWindows[window]);
  const double walk = noise_.walk_variance(k) * (length + 1.0) * (2.0 * length + 1.0) / (6.0 * length);
  return level_uncertainty_[window][k] + walk + noise_.block_variance(k, b_) / length;
}

ChannelWindows::LevelResidual ChannelWindows::level_residual(std::size_t k, std::size_t window, const Set& set,
                                                             const std::vector<std::size_t>& from) const {
  const std::size_t length = kLevelWindows[window];
  const auto usable = [&](std::size_t j) { return all_there(j, length) && b_ + 1 >= from[j] + length; };
  if (!usable(k)) return {};
  double weights = 0.0, others = 0.0, own = 0.0;
  for (std::size_t j = 0; j < sensors_; ++j) {
    if ((j != k && !set[j]) || !usable(j)) continue;
    const double mean =
        (sum_(at(j), at(b_ + 1)) - sum_(at(j), at(b_ + 1 - length))) / static_cast<double>(length) - level_[window][j];
    if (j == k) {
      own = mean;
      continue;
    }
    const double weight = 1.0 / level_variance(j, window);
    weights += weight;
    others += weight * mean;
  }
  if (weights <= 0.0) return {};
  return {true, own - others / weights, level_variance(k, window) + 1.0 / weights};
}

void ChannelWindows::enter(std::size_t b, const Set& set) {
  const bool again = entered_ == b + 1;
  b_ = b;
  entered_ = b + 1;
  if (!again)
    for (std::size_t k = 0; k < sensors_; ++k) run_[k] = has(k, b) ? run_[k] + 1 : 0;
  residuals_of_block(set, again);
}

void ChannelWindows::residuals_of_block(const Set& set, bool again) {
  const auto length = at(blocks_.length);
  Eigen::MatrixXd own(at(sensors_), length);
  for (std::size_t k = 0; k < sensors_; ++k) {
    if (!has(k, b_)) continue;
    own.row(at(k)) = signals_.sensors[k].values.row(channel_).segment(at(b_) * length, length);
    own.row(at(k)).array() -= own.row(at(k)).mean();
  }
  for (std::size_t k = 0; k < sensors_; ++k) residual_of_block(k, set, own, again);
}

/// The last blocks, as long as the longest window, are repeated with the smaller set and then put back.
SensorTest ChannelWindows::largest_among(const Set& rest, const std::vector<std::size_t>& from) {
  const std::size_t last = b_, count = std::min(last + 1, kMotionWindows.back());
  const auto first = at(last + 1 - count), width = at(count);
  const Eigen::MatrixXd residual = residual_.middleCols(first, width), variance = variance_.middleCols(first, width),
                        ratio = ratio_.middleCols(first, width);
  std::vector<Eigen::Matrix4Xd> cross;
  for (const Eigen::Matrix4Xd& sums : cross_) cross.emplace_back(sums.middleCols(first + 1, width));
  for (b_ = last + 1 - count; b_ < last; ++b_) residuals_of_block(rest, true);
  residuals_of_block(rest, true);
  SensorTest most;
  for (std::size_t j = 0; j < sensors_; ++j) {
    if (!rest[j]) continue;
    const TestValue own = largest(j, rest, from);
    if (own.excess > most.test.excess) most = {j, own};
  }
  residual_.middleCols(first, width) = residual;
  variance_.middleCols(first, width) = variance;
  ratio_.middleCols(first, width) = ratio;
  for (std::size_t j = 0; j < sensors_; ++j) cross_[j].middleCols(first + 1, width) = cross[j];
  return most;
}

/// Relative to the mean of the others weighted by their noise: the block's mean, and its samples about it.
void ChannelWindows::residual_of_block(std::size_t k, const Set& set, const Eigen::MatrixXd& own, bool again) {
  double weights = 0.0, others = 0.0, sample_weights = 0.0;
  Eigen::RowVectorXd samples = Eigen::RowVectorXd::Zero(own.cols());
  for (std::size_t j = 0; j < sensors_ && has(k, b_); ++j) {
    if (j == k || !set[j] || !has(j, b_)) continue;
    const double weight = 1.0 / noise_.block_variance(j, b_);
    const double sample_weight = 1.0 / noise_.sample_variance(j, b_);
    weights += weight;
    others += weight * (blocks_.means[j](channel_, at(b_)) - level_[1][j]);
    sample_weights += sample_weight;
    samples += sample_weight * own.row(at(j));
  }
  const bool valid = weights > 0.0;
  if (!again) valid_run_[k] = valid ? valid_run_[k] + 1 : 0;
  const double e = valid ? blocks_.means[k](channel_, at(b_)) - level_[1][k] - others / weights : 0.0;
  residual_(at(k), at(b_)) = e;
  variance_(at(k), at(b_)) = valid ? noise_.block_variance(k, b_) + 1.0 / weights : 0.0;
  ratio_(at(k), at(b_)) = valid
                              ? (own.row(at(k)) - samples / sample_weights).squaredNorm() /
                                    static_cast<double>(own.cols() - 1) / (noise_.sample_variance(k, b_) + 1.0 / sample_weights)
                              : 0.0;
  const Eigen::Vector3d x = motion_.col(at(b_ + 1)).head<3>() - motion_.col(at(b_)).head<3>();
  cross_[k].col(at(b_ + 1)) = cross_[k].col(at(b_)) + Eigen::Vector4d(e, e * x(0), e * x(1), e * x(2));
}

/// Negative if the window is incomplete.
double ChannelWindows::noise_ratio(std::size_t k, std::size_t blocks, std::size_t since) const {
  if (valid_run_[k] < blocks || b_ + 1 < since + blocks) return -1.0;
  return ratio_.row(at(k)).segment(at(b_ + 1 - blocks), at(blocks)).mean();
}

double ChannelWindows::motion_chi2(std::size_t k, std::size_t blocks, std::size_t since) const {
  if (valid_run_[k] < blocks || b_ + 1 < since + blocks) return -1.0;
  const auto length = static_cast<double>(blocks);
  const Eigen::Matrix<double, 9, 1> sums = motion_.col(at(b_ + 1)) - motion_.col(at(b_ + 1 - blocks));
  const Eigen::Vector4d cross = cross_[k].col(at(b_ + 1)) - cross_[k].col(at(b_ + 1 - blocks));
  const Eigen::Vector3d x = sums.head<3>();
  Eigen::Matrix3d A;
  A << sums(3), sums(4), sums(5), sums(4), sums(6), sums(7), sums(5), sums(7), sums(8);
  A -= x * x.transpose() / length;
  const Eigen::Vector3d g = cross.tail<3>() - x * cross(0) / length;
  // The constant response, subtracted before, is from differences over the record: two variances over its length.
  // Noise of the common signal counts as motion without information: if there is only noise the statistic goes to zero.
  const double variance = variance_(at(k), at(b_)) * (1.0 + 2.0 * length / static_cast<double>(blocks_.count));
  A.diagonal().array() += variance * length;
  return g.dot(A.ldlt().solve(g)) / variance;
}

void ChannelWindows::keep_noise_and_motion(std::size_t k, std::size_t since, TestValue& best) const {
  const auto keep = [&](const TestValue& value) {
    if (value.excess > best.excess) best = value;
  };
  for (std::size_t i = 0; i < kNoiseWindows.size(); ++i) {
    const std::size_t blocks = kNoiseWindows[i];
    const double ratio = noise_ratio(k, blocks, since);
    if (ratio < 0.0) continue;
    const SpreadOfWindow spread = mean_of(spread_of_samples_, blocks);
    const double s = ratio / noise_learnt_[i][k].growth(spread);
    const NormalScore score(dof(k) * static_cast<double>(blocks));
    const double threshold = score(noise_threshold_[i][k]) * std::sqrt(noise_learnt_[i][k].tail(spread));
    keep({TestValue::Kind::kNoise, i, score(s) / threshold, score(s), s});
  }
  for (std::size_t i = 0; i < kMotionWindows.size(); ++i) {
    const double chi2 = motion_chi2(k, kMotionWindows[i], since);
    if (chi2 < 0.0) continue;
    const double q = chi2 / motion_learnt_[i][k].factor(motion_of(kMotionWindows[i]));
    keep({TestValue::Kind::kMotion, i, std::sqrt(q / motion_threshold_[i]), std::sqrt(q), q});
  }
}

TestValue ChannelWindows::largest(std::size_t k, const Set& set, const std::vector<std::size_t>& from) const {
  TestValue best;
  for (std::size_t i = 0; i < kLevelWindows.size(); ++i) {
    const LevelResidual level = level_residual(k, i, set, from);
    if (!level.valid) continue;
    const double q =
        level.value * level.value / level.variance / level_learnt_[i][k].factor(mean_of(spread_of_means_, kLevelWindows[i]));
    const double excess = std::sqrt(q / level_threshold_[i]);
    if (excess > best.excess) best = {TestValue::Kind::kLevel, i, excess, std::sqrt(q), 1.0};
  }
  keep_noise_and_motion(k, from[k], best);
  return best;
}

TestValue ChannelWindows::largest_on_trial(std::size_t k, std::size_t since) const {
  TestValue best;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t blocks = kLevelWindows[i];
    if (valid_run_[k] < blocks || b_ + 1 < since + 2 * blocks) continue;
    const auto before = static_cast<double>(b_ + 1 - blocks - since);
    const auto length = static_cast<double>(blocks);
    const auto sum = [&](std::size_t n) { return cross_[k](0, at(n)); };
    const double mean = (sum(b_ + 1 - blocks) - sum(since)) / before;
    const double now = (sum(b_ + 1) - sum(b_ + 1 - blocks)) / length;
    const double variance =
        variance_(at(k), at(b_)) * (1.0 / before + 1.0 / length) + noise_.walk_variance(k) * (before + length) / 3.0;
    const double q = (now - mean) * (now - mean) / variance / level_learnt_[i][k].factor(mean_of(spread_of_means_, blocks));
    const double excess = std::sqrt(q / level_threshold_[i]);
    if (excess > best.excess) best = {TestValue::Kind::kLevel, i, excess, std::sqrt(q), 1.0};
  }
  keep_noise_and_motion(k, since, best);
  return best;
}

}  // namespace coast::array
