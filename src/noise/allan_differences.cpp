#include "allan_differences.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coast::noise {

namespace {

constexpr int kLevelBits = 6;               // at least 2^6 blocks per average: 64-fold overlap
constexpr std::size_t kLanes = 4;           // independent sums, in the same order on every machine
constexpr std::size_t kFreshPoints = 2048;  // differences are computed for so many at once: with history within the L1 cache
constexpr double kLongestAverage = 0x1p50;  // samples

/// Sum of squares of the second differences that end in [begin, end).
double second_differences(const double* x, std::size_t begin, std::size_t end, std::size_t k) {
  std::array<double, kLanes> sum{};
  const auto square = [x, k](std::size_t i) {
    const double difference = (x[i] - x[i - k]) - (x[i - k] - x[i - 2 * k]);
    return difference * difference;
  };
  std::size_t i = begin;
  for (; i + kLanes <= end; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sum[lane] += square(i + lane);
  for (; i < end; ++i) sum[0] += square(i);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

struct BothSums {
  double second;
  double third;
};

/// Second and third differences in one pass: they use the same points.
BothSums both_differences(const double* x, std::size_t begin, std::size_t end, std::size_t k) {
  std::array<double, kLanes> second{};
  std::array<double, kLanes> third{};
  const auto add = [&](std::size_t i, std::size_t lane) {
    const double middle = x[i - k] - x[i - 2 * k];
    const double difference = (x[i] - x[i - k]) - middle;
    const double before = middle - (x[i - 2 * k] - x[i - 3 * k]);
    second[lane] += difference * difference;
    third[lane] += (difference - before) * (difference - before);
  };
  std::size_t i = begin;
  for (; i + kLanes <= end; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(i + lane, lane);
  for (; i < end; ++i) add(i, 0);
  return {(second[0] + second[1]) + (second[2] + second[3]), (third[0] + third[1]) + (third[2] + third[3])};
}

}  // namespace

void add_differences(std::span<const double> x, std::size_t fresh, std::size_t k, DifferenceSums& sums) {
  const std::size_t second_begin = std::max(fresh, 2 * k);
  if (second_begin >= x.size()) return;
  const std::size_t third_begin = std::min(std::max(fresh, 3 * k), x.size());
  sums.second += second_differences(x.data(), second_begin, third_begin, k);
  const BothSums both = both_differences(x.data(), third_begin, x.size(), k);
  sums.second += both.second;
  sums.third += both.third;
  sums.second_terms += x.size() - second_begin;
  sums.third_terms += x.size() - third_begin;
  // The first term of a run ends 2k, 3k points after its start, when fresh points have not yet replaced history.
  if (second_begin == 2 * k) ++sums.second_runs;
  if (third_begin == 3 * k && third_begin < x.size()) ++sums.third_runs;
}

std::vector<AveragingFactor> averaging_factors(int points_per_decade) {
  std::vector<AveragingFactor> factors;
  for (int i = 0;; ++i) {
    const double target = std::pow(10.0, static_cast<double>(i) / points_per_decade);
    if (target > kLongestAverage) return factors;
    AveragingFactor factor{.level = std::max(0, std::ilogb(target) - kLevelBits), .k = 0};
    factor.k = static_cast<std::size_t>(std::llround(std::ldexp(target, -factor.level)));
    if (factor.k == 2U << kLevelBits) factor = {.level = factor.level + 1, .k = 1U << kLevelBits};
    if (factors.empty() || factors.back().samples() != factor.samples()) factors.push_back(factor);
  }
}

DifferenceLevel::DifferenceLevel(std::vector<std::size_t> lags)
    : lags_(std::move(lags)), sums_(lags_.size()), history_(3 * (2U << kLevelBits)) {
  x_.reserve(history_ + kFreshPoints + 1);
  end_run();
}

void DifferenceLevel::add(std::span<const double> sums, std::vector<double>& pairs) {
  pairs.clear();
  for (const double sum : sums) {
    x_.push_back(x_.back() + sum);
    if (x_.size() == x_.capacity()) take_differences();
    if (odd_) pairs.push_back(waiting_ + sum);
    waiting_ = sum;
    odd_ = !odd_;
  }
}

void DifferenceLevel::take_differences() {
  for (std::size_t j = 0; j < lags_.size(); ++j) add_differences(x_, fresh_, lags_[j], sums_[j]);
  if (x_.size() > history_) x_.erase(x_.begin(), x_.end() - static_cast<std::ptrdiff_t>(history_));
  // Differences do not depend on a constant; it is subtracted so that the integral of a long record never grows large.
  const double last = x_.back();
  for (double& x : x_) x -= last;
  fresh_ = x_.size();
}

void DifferenceLevel::end_run() {
  if (fresh_ < x_.size()) take_differences();
  x_.assign(1, 0.0);
  fresh_ = 1;
  odd_ = false;
}

void DifferencePyramid::add_level() {
  std::vector<std::size_t> lags;
  for (const AveragingFactor& factor : factors_)
    if (factor.level == static_cast<int>(levels_.size())) lags.push_back(factor.k);
  levels_.emplace_back(std::move(lags));
  pairs_.emplace_back();
}

void DifferencePyramid::add(std::span<const double> samples) {
  for (std::size_t level = 0; !samples.empty(); ++level) {
    if (level == levels_.size()) add_level();
    levels_[level].add(samples, pairs_[level]);
    samples = pairs_[level];
  }
}

void DifferencePyramid::end_run() {
  for (DifferenceLevel& level : levels_) level.end_run();
}

std::vector<DifferenceSums> DifferencePyramid::sums() const {
  std::vector<DifferenceSums> all;
  all.reserve(factors_.size());
  for (const AveragingFactor& factor : factors_) {
    const auto level = static_cast<std::size_t>(factor.level);
    if (level >= levels_.size()) {
      all.emplace_back();
      continue;
    }
    const auto& lags = levels_[level].lags();
    const auto at = std::ranges::find(lags, factor.k) - lags.begin();
    all.push_back(levels_[level].sums()[static_cast<std::size_t>(at)]);
  }
  return all;
}

}  // namespace coast::noise
