#include "parity_noise.hpp"

#include <algorithm>
#include <cmath>

namespace coast::array {

namespace {

constexpr double kChi2Median = 0.4549;  // of one degree of freedom
constexpr double kMadToSd = 1.4826;     // of a normal
constexpr double kMedianSpread = 1.25;  // sqrt(n) sd(median)/sd of a normal
constexpr double kMadSpread = 1.17;     // sqrt(n) sd(MAD scale)/scale of a normal (Rousseeuw & Croux 1993)
constexpr double kNodeSeconds = 10.0;
constexpr double kNoBound = 1e100;

struct SpanOfBlocks {
  std::size_t from, to;
};

double median_of_squares(const Eigen::MatrixXd& squares, std::size_t sensor, SpanOfBlocks span, std::vector<double>& work) {
  work.clear();
  for (std::size_t b = span.from; b < span.to; ++b) {
    const double value = squares(static_cast<Eigen::Index>(sensor), static_cast<Eigen::Index>(b));
    if (value >= 0.0) work.push_back(value);
  }
  return median_of(work);
}

}  // namespace

Eigen::VectorXd own_variances(const Eigen::VectorXd& of_residuals) {
  const auto count = static_cast<double>(of_residuals.size());
  const double sum = of_residuals.sum() / (1.0 - 1.0 / count);
  if (of_residuals.size() == 2) return Eigen::VectorXd::Constant(2, sum / 2.0);
  const Eigen::ArrayXd own = (of_residuals.array() - sum / (count * count)) / (1.0 - 2.0 / count);
  return own.max(sum / count / 50.0).matrix();
}

double median_over_mean(double nu) {
  return std::pow(1.0 - 2.0 / (9.0 * nu), 3);
}

ChannelNoise::ChannelNoise(const Signals& signals, const ParityBlocks& blocks, int channel, double memory_s)
    : blocks_(blocks), channel_(channel), sensors_(signals.sensors.size()), dof_(sensors_, 1.0) {
  find_members();
  if (members_.size() < 2) {
    step_ = blocks.count + 1;
    level_.setConstant(static_cast<Eigen::Index>(sensors_), 2, kNoBound);
    ratio_.assign(sensors_, 1.0);
    walk_.assign(sensors_, 0.0);
    return;
  }
  mean_squares(signals);
  degrees_of_freedom();
  levels(memory_s);
  slow_noise();
  squares_.resize(0, 0);
}

void ChannelNoise::find_members() {
  for (std::size_t k = 0; k < sensors_; ++k) {
    std::size_t there = 0;
    for (std::size_t b = 0; b < blocks_.count; ++b) there += blocks_.has(k, channel_, b) ? 1 : 0;
    if (4 * there >= blocks_.count) members_.push_back(k);
  }
}

/// Values of the members; the others get the largest of them.
Eigen::VectorXd ChannelNoise::for_all(const Eigen::VectorXd& of_members) const {
  Eigen::VectorXd all = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(sensors_), of_members.maxCoeff());
  for (std::size_t m = 0; m < members_.size(); ++m)
    all(static_cast<Eigen::Index>(members_[m])) = of_members(static_cast<Eigen::Index>(m));
  return all;
}

/// About the block's mean, so that slow differences have no effect and white noise has exactly length - 1 degrees of freedom.
void ChannelNoise::mean_squares(const Signals& signals) {
  const auto length = static_cast<Eigen::Index>(blocks_.length);
  squares_.setConstant(static_cast<Eigen::Index>(members_.size()), static_cast<Eigen::Index>(blocks_.count), -1.0);
  Eigen::MatrixXd residual(static_cast<Eigen::Index>(members_.size()), length);
  for (std::size_t b = 0; b < blocks_.count; ++b) {
    bool all = true;
    for (const std::size_t k : members_) all = all && blocks_.has(k, channel_, b);
    if (!all) continue;
    for (std::size_t m = 0; m < members_.size(); ++m)
      residual.row(static_cast<Eigen::Index>(m)) =
          signals.sensors[members_[m]].values.row(channel_).segment(static_cast<Eigen::Index>(b) * length, length);
    residual.rowwise() -= residual.colwise().mean().eval();
    residual.colwise() -= residual.rowwise().mean().eval();
    squares_.col(static_cast<Eigen::Index>(b)) = residual.rowwise().squaredNorm() / static_cast<double>(length - 1);
  }
}

/// From the spread of the cube roots, sqrt(2/(9 nu)) of their middle, within a minute so that slow changes have no effect.
void ChannelNoise::degrees_of_freedom() {
  constexpr std::size_t kPiece = 600;
  const auto most = static_cast<double>(blocks_.length - 1);
  for (std::size_t m = 0; m < members_.size(); ++m) {
    std::vector<double> from_middle, work;
    for (std::size_t from = 0; from < blocks_.count; from += kPiece) {
      const SpanOfBlocks span{from, std::min(from + kPiece, blocks_.count)};
      const double middle = std::cbrt(median_of_squares(squares_, m, span, work));
      if (!(middle > 0.0)) continue;
      for (const double value : work) from_middle.push_back(std::abs(std::cbrt(value) / middle - 1.0));
    }
    const double spread = kMadToSd * median_of(from_middle);
    dof_[members_[m]] = spread > 0.0 ? std::clamp(2.0 / (9.0 * spread * spread), std::min(1.0, most), most) : most;
  }
}

/// Running medians at nodes. Slowly varying noise uses the centred one. If past and future differ by half, one of them is
/// defective: the smaller is used, so that a long burst does not hide itself.
void ChannelNoise::levels(double memory_s) {
  constexpr double kSudden = 1.5;
  step_ = static_cast<std::size_t>(std::max(1.0, std::round(kNodeSeconds / blocks_.seconds)));
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(memory_s / blocks_.seconds)));
  const std::size_t nodes = (blocks_.count - 1) / step_ + 2;
  Eigen::MatrixXd residual(static_cast<Eigen::Index>(members_.size()), static_cast<Eigen::Index>(nodes));
  std::vector<double> work;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const double whole = median_of_squares(squares_, m, {0, blocks_.count}, work);
    for (std::size_t node = 0; node < nodes; ++node) {
      const std::size_t at = std::min(node * step_, blocks_.count);
      const SpanOfBlocks past{at > reach ? at - reach : 0, at}, future{at, std::min(at + reach, blocks_.count)};
      double level = median_of_squares(squares_, m, {past.from, future.to}, work);
      if (past.to - past.from >= reach / 4 && future.to - future.from >= reach / 4) {
        const double before = median_of_squares(squares_, m, past, work);
        const double after = median_of_squares(squares_, m, future, work);
        if (before > 0.0 && after > 0.0 && std::max(before, after) > kSudden * std::min(before, after))
          level = std::min(before, after);
      }
      residual(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(node)) =
          (level > 0.0 ? level : whole) / median_over_mean(dof_[members_[m]]);
    }
  }
  level_.resize(static_cast<Eigen::Index>(sensors_), residual.cols());
  for (Eigen::Index node = 0; node < residual.cols(); ++node)
    level_.col(node) = for_all(own_variances(residual.col(node))).cwiseMax(kLeastVariance);
  const double blocks_used = static_cast<double>(std::min(2 * reach, blocks_.count));
  const double least = *std::min_element(dof_.begin(), dof_.end());
  sample_uncertainty_ = kMedianSpread / std::sqrt(2.0 * least * blocks_used);
}

double ChannelNoise::sample_variance(std::size_t k, std::size_t b) const {
  const auto row = static_cast<Eigen::Index>(k);
  const auto node = static_cast<Eigen::Index>(b / step_);
  const double along = static_cast<double>(b % step_) / static_cast<double>(step_);
  return (1.0 - along) * level_(row, node) + along * level_(row, node + 1);
}

double ChannelNoise::residual_sample_variance(std::size_t k, std::size_t b) const {
  const auto count = static_cast<double>(members_.size());
  double sum = 0.0;
  for (const std::size_t j : members_) sum += sample_variance(j, b);
  return std::max(sample_variance(k, b) * (1.0 - 2.0 / count) + sum / (count * count), 1e-300);
}

/// For the residuals about the plain mean: median square of the difference of neighbouring windows' means over the
/// variance of their samples, so that slow changes of the noise cancel.
Eigen::VectorXd ChannelNoise::allan_of(std::size_t window, std::size_t& pairs) const {
  const std::size_t hop = std::max<std::size_t>(1, window / 2);
  const std::size_t count = members_.size();
  std::vector<std::vector<double>> ratios(count);
  for (std::size_t from = 0; from + 2 * window <= blocks_.count; from += hop) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
    bool all = true;
    for (std::size_t i = 0; i < 2 * window && all; ++i) {
      for (std::size_t m = 0; m < count && all; ++m) {
        all = blocks_.has(members_[m], channel_, from + i);
        const double value = blocks_.means[members_[m]](channel_, static_cast<Eigen::Index>(from + i));
        change(static_cast<Eigen::Index>(m)) += i < window ? -value : value;
      }
    }
    if (!all) continue;
    change.array() = (change.array() - change.mean()) / static_cast<double>(window);
    for (std::size_t m = 0; m < count; ++m)
      ratios[m].push_back(std::pow(change(static_cast<Eigen::Index>(m)), 2) /
                          residual_sample_variance(members_[m], from + window));
  }
  pairs = ratios[0].size();
  Eigen::VectorXd result(static_cast<Eigen::Index>(count));
  for (std::size_t m = 0; m < count; ++m)
    result(static_cast<Eigen::Index>(m)) =
        median_of(ratios[m]) / kChi2Median * residual_sample_variance(members_[m], blocks_.count / 2);
  return for_all(own_variances(result));
}

/// Windows of W blocks: var(difference of neighbours) = 2 a/W + 2 q W/3. White noise a from 0.1 s or 1 s, whichever is larger
/// (they agree if correlation is shorter than a block); the walk q from 1 s on, plus one standard deviation: a short record has
/// little information on it.
void ChannelNoise::slow_noise() {
  constexpr std::size_t kLong = 10;
  std::size_t pairs = 0;
  const Eigen::VectorXd one = allan_of(1, pairs) / 2.0;
  const Eigen::VectorXd ten = allan_of(kLong, pairs) * (kLong / 2.0);
  const Eigen::VectorXd white = one.cwiseMax(ten);
  level_uncertainty_ = kMadSpread / std::sqrt(static_cast<double>(std::max<std::size_t>(pairs, 1)));
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(white.size()), sum = weights;
  for (std::size_t window = kLong; 8 * window <= blocks_.count && window <= 64 * kLong; window *= 2) {
    const Eigen::VectorXd allan = allan_of(window, pairs);
    if (pairs < 4) continue;
    const auto length = static_cast<double>(window);
    for (Eigen::Index k = 0; k < white.size(); ++k) {
      const double sd = 1.5 / length * 2.0 * kMadSpread * allan(k) / std::sqrt(static_cast<double>(pairs));
      const double weight = 1.0 / std::max(sd * sd, 1e-300);
      weights(k) += weight;
      sum(k) += weight * 1.5 / length * (allan(k) - 2.0 * white(k) / length);
    }
  }
  for (std::size_t k = 0; k < sensors_; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    ratio_.push_back(white(row) / std::max(sample_variance(k, blocks_.count / 2), 1e-300));
    walk_.push_back(weights(row) > 0.0 ? std::max(0.0, sum(row) / weights(row)) + 1.0 / std::sqrt(weights(row)) : 0.0);
  }
}

}  // namespace coast::array
