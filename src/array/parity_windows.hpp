#pragma once
// The residuals of one channel and their tests over windows of blocks. Private to the room.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "parity_noise.hpp"
#include "parity_spread.hpp"
#include "parity_thresholds.hpp"

namespace coast::array {

/// A test and its result: `excess` is the statistic over its threshold, both as standard deviations of a normal.
struct TestValue {
  enum class Kind : std::uint8_t { kNone, kLevel, kNoise, kMotion };
  Kind kind = Kind::kNone;
  std::size_t window = 0;  ///< index in the windows of its kind
  double excess = 0.0;
  double statistic = 0.0;
  double ratio = 1.0;  ///< kNoise: mean square over the usual one
};

struct SensorTest {
  std::size_t sensor = 0;
  TestValue test;
};

/// What the record shows of a test of one sensor.
struct LearntTest {
  std::vector<RatioAtSpread> ratios;  ///< until the growth is known
  Growth own, usual;                  ///< of this sensor; median over all

  /// Factors on the squared threshold. What a sensor shows beyond all others is a defect of it, also where it lasts for most of
  /// the record.
  [[nodiscard]] double growth(const SpreadOfWindow& spread) const {
    constexpr double kMost = 1.2;
    return std::min(own.inflation.at(spread.now), kMost * usual.inflation.at(spread.now));
  }
  [[nodiscard]] double tail(const SpreadOfWindow& spread) const {
    constexpr double kMost = 1.5;
    return std::min(own.tail(spread), kMost * usual.tail(spread));
  }
  [[nodiscard]] double factor(const SpreadOfWindow& spread) const { return growth(spread) * tail(spread); }
};

/// A mean square of nu degrees of freedom over its mean, as a standard normal (Wilson & Hilferty 1931).
struct NormalScore {
  explicit NormalScore(double nu) : spread(std::sqrt(2.0 / (9.0 * nu))) {}
  double operator()(double ratio) const { return (std::cbrt(ratio) - 1.0 + spread * spread) / spread; }
  double spread;
};

/// Statistics of one channel's K sensors at a block, against sets of sensors that are in order.
class ChannelWindows {
 public:
  using Set = std::vector<bool>;

  /// @param share_per_hour  false alarms of each test
  ChannelWindows(const Signals& signals, const ParityBlocks& blocks, const ChannelNoise& noise, const SensorSpread& spread,
                 int channel, double share_per_hour);

  /// Residuals of all sensors at block b relative to the available ones of the set. Repeated for the same b with a smaller set.
  void enter(std::size_t b, const Set& set);
  /// Largest test of a sensor in the set at the last entered block; windows begin at `from[k]` or later.
  [[nodiscard]] TestValue largest(std::size_t k, const Set& set, const std::vector<std::size_t>& from) const;
  /// Largest test among the sensors of a smaller set than the entered one, with residuals relative to one another alone.
  [[nodiscard]] SensorTest largest_among(const Set& rest, const std::vector<std::size_t>& from);
  /// Largest test of a sensor on trial since block `since` relative to the mean of its own residual since then.
  [[nodiscard]] TestValue largest_on_trial(std::size_t k, std::size_t since) const;
  /// Adds the block that has left each window to the past, for sensors in the set since `in_order_from`.
  void absorb(std::size_t b, const Set& set, const std::vector<std::size_t>& in_order_from);
  /// New level from the residuals of blocks [since, b].
  void take_back(std::size_t k, std::size_t since, std::size_t b);
  /// Moves the level of k at one window by its residual at this block.
  void follow(std::size_t k, std::size_t window, const Set& set, const std::vector<std::size_t>& from);
  /// Moves the levels of k at all windows to its level in one window.
  void move_to(std::size_t k, std::size_t window, const Set& set, const std::vector<std::size_t>& from);

  /// Squares at block b for the fit of the tests; windows that do not overlap.
  void learn(std::size_t b, const Set& set, const std::vector<std::size_t>& from);
  void fit_learnt();

  /// Residual of sensor k at block i, and its variance; absent blocks have variance 0.
  [[nodiscard]] double residual(std::size_t k, std::size_t i) const { return residual_(at(k), at(i)); }
  [[nodiscard]] double residual_variance(std::size_t k, std::size_t i) const { return variance_(at(k), at(i)); }
  /// Mean square of the samples of block i over the usual one; 0 if absent.
  [[nodiscard]] double roughness_ratio(std::size_t k, std::size_t i) const { return ratio_(at(k), at(i)); }
  /// Mean residual since a block, relative to the past, in standard deviations.
  [[nodiscard]] double shift_of_level(std::size_t k, std::size_t since) const;
  /// Mean square of the samples since a block over the usual one.
  [[nodiscard]] double noise_since(std::size_t k, std::size_t since) const {
    return ratio_.row(at(k)).segment(at(since), at(b_ + 1 - since)).mean();
  }
  /// Power of the motion, mean over blocks [first, last].
  [[nodiscard]] double power(std::size_t first, std::size_t last) const {
    return (power_(at(last + 1)) - power_(at(first))) / static_cast<double>(last + 1 - first);
  }
  [[nodiscard]] double dof(std::size_t k) const { return noise_.block_dof(k); }
  [[nodiscard]] bool has(std::size_t k, std::size_t b) const { return blocks_.has(k, channel_, b); }
  [[nodiscard]] std::size_t sensors() const { return sensors_; }

 private:
  struct LevelResidual {
    bool valid = false;
    double value = 0.0;
    double variance = 0.0;
  };
  static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
  void start_levels();
  void motion_sums();
  void residuals_of_block(const Set& set, bool again);
  void residual_of_block(std::size_t k, const Set& set, const Eigen::MatrixXd& own, bool again);
  using SquareOfRatio = std::function<double(std::size_t k, double ratio)>;
  void set_thresholds();
  [[nodiscard]] double median_noise_ratio(std::size_t k, std::size_t blocks) const;
  [[nodiscard]] TailFit tail_fit(std::size_t window) const;
  /// @param square  what is a squared normal, of a ratio of sensor k
  void fit_tests(std::vector<LearntTest>& sensors, std::size_t window, const std::vector<double>& thresholds,
                 const SquareOfRatio& square) const;
  /// Means over the window.
  [[nodiscard]] SpreadOfWindow mean_of(const SpreadSeries& running_sums, std::size_t window) const {
    const auto mean = [&](const Eigen::VectorXd& sums) {
      return (sums(at(b_ + 1)) - sums(at(b_ + 1 - window))) / static_cast<double>(window);
    };
    return {mean(running_sums.now), mean(running_sums.about)};
  }
  /// For a response to motion: errors of the response grow with the motion itself.
  [[nodiscard]] SpreadOfWindow motion_of(std::size_t window) const {
    return {power(b_ + 1 - window, b_), mean_of(spread_of_means_, window).about};
  }
  [[nodiscard]] bool all_there(std::size_t k, std::size_t window) const { return run_[k] >= window; }
  [[nodiscard]] LevelResidual level_residual(std::size_t k, std::size_t window, const Set& set,
                                             const std::vector<std::size_t>& from) const;
  [[nodiscard]] double level_variance(std::size_t k, std::size_t window) const;
  [[nodiscard]] double noise_ratio(std::size_t k, std::size_t blocks, std::size_t since) const;
  [[nodiscard]] double motion_chi2(std::size_t k, std::size_t blocks, std::size_t since) const;
  void keep_noise_and_motion(std::size_t k, std::size_t since, TestValue& best) const;

  const Signals& signals_;
  const ParityBlocks& blocks_;
  const ChannelNoise& noise_;
  int channel_;
  double share_per_hour_;
  std::size_t sensors_;
  std::size_t b_ = 0;
  std::size_t entered_ = 0;                      ///< number of blocks
  Eigen::MatrixXd sum_;                          ///< sensor x (blocks + 1): running sums of means
  Eigen::MatrixXd residual_, variance_, ratio_;  ///< sensor x block
  std::vector<std::size_t> run_, valid_run_;     ///< consecutive blocks up to now that are whole, that have a residual
  std::array<std::vector<double>, 3> level_, level_uncertainty_;  ///< of the past, by window and sensor
  Eigen::MatrixXd motion_;                              ///< 9 x (blocks + 1): running sums of x and the upper part of x x'
  std::vector<Eigen::Matrix4Xd> cross_;                 ///< [sensor] 4 x (blocks + 1): running sums of residual, x residual
  Eigen::VectorXd power_;                               ///< running sums
  SpreadSeries spread_of_means_, spread_of_samples_;    ///< running sums
  std::array<double, 3> level_threshold_{};             ///< squared
  std::array<std::vector<double>, 2> noise_threshold_;  ///< by sensor, of the ratio
  std::array<double, 2> motion_threshold_{};
  template <std::size_t Windows>
  using Learnt = std::array<std::vector<LearntTest>, Windows>;  ///< [window][sensor]
  Learnt<3> level_learnt_;
  Learnt<2> noise_learnt_, motion_learnt_;
};

}  // namespace coast::array
