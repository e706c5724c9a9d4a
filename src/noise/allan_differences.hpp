#pragma once
// Sums of squared second and third differences of the integrated signal, and the pyramid of block sums they are computed from.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace coast::noise {

/// Sums at one averaging factor.
struct DifferenceSums {
  double second = 0.0;  ///< of (x[i] - 2 x[i-k] + x[i-2k])^2
  double third = 0.0;   ///< of (x[i] - 3 x[i-k] + 3 x[i-2k] - x[i-3k])^2
  std::uint64_t second_terms = 0;
  std::uint64_t third_terms = 0;
  std::uint64_t second_runs = 0;  ///< number of runs with at least one term
  std::uint64_t third_runs = 0;
};

/// Adds the terms whose last point is at `fresh` or later. x: the integrated signal of one run; points before `fresh` were
/// processed before. @param k lag in points, >= 1
void add_differences(std::span<const double> x, std::size_t fresh, std::size_t k, DifferenceSums& sums);

/// Averaging factors of all records: about equally spaced in logarithm, rounded to 7 significant bits.
struct AveragingFactor {
  int level;      ///< blocks of 2^level samples; 0 below 128 samples
  std::size_t k;  ///< blocks per average, 64 to 127 above level 0
  [[nodiscard]] std::uint64_t samples() const { return static_cast<std::uint64_t>(k) << static_cast<unsigned>(level); }
};
[[nodiscard]] std::vector<AveragingFactor> averaging_factors(int points_per_decade);

/// One level of the pyramid: integrates blocks, keeps three times its longest average, adds differences as blocks arrive.
class DifferenceLevel {
 public:
  explicit DifferenceLevel(std::vector<std::size_t> lags);
  /// The next blocks' sums. Sums of two blocks are left in `pairs` for the next level.
  void add(std::span<const double> sums, std::vector<double>& pairs);
  void end_run();
  [[nodiscard]] const std::vector<std::size_t>& lags() const { return lags_; }
  [[nodiscard]] const std::vector<DifferenceSums>& sums() const { return sums_; }

 private:
  void take_differences();

  std::vector<std::size_t> lags_;
  std::vector<DifferenceSums> sums_;
  std::size_t history_;    ///< number of earlier points that the longest difference needs
  std::vector<double> x_;  ///< the integral, from some point on: history, then fresh points
  std::size_t fresh_ = 0;  ///< first point that was not yet the end of a difference
  bool odd_ = false;       ///< a block waits for its partner
  double waiting_ = 0.0;
};

/// All levels. Levels are added as the record grows.
class DifferencePyramid {
 public:
  explicit DifferencePyramid(std::vector<AveragingFactor> factors) : factors_(std::move(factors)) {}
  void add(std::span<const double> samples);
  void end_run();
  /// The sums of each factor, in the given order; zero if its level was not reached.
  [[nodiscard]] std::vector<DifferenceSums> sums() const;

 private:
  void add_level();

  std::vector<AveragingFactor> factors_;
  std::vector<DifferenceLevel> levels_;
  std::vector<std::vector<double>> pairs_;  ///< scratch, one per level
};

}  // namespace coast::noise
