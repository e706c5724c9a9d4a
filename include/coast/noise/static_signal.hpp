#pragma once
// One axis of a sensor at rest, on a regular grid in time that may have holes.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace coast::noise {

/// Samples of one axis, mean rate or specific force over the interval that ends at each. Missing samples are holes in the grid;
/// they are not filled.
struct StaticSignal {
  /// Consecutive samples without a hole.
  struct Run {
    std::uint64_t start = 0;  ///< grid index of its first sample, in intervals from the signal's first sample
    std::size_t first = 0;    ///< index of its first sample in `values`
    std::size_t count = 0;
  };

  std::string source;
  double interval = 0.0;  ///< s, > 0
  std::vector<double> values;
  std::vector<Run> runs;

  /// A signal without holes.
  [[nodiscard]] static StaticSignal regular(std::vector<double> values, double interval, const std::string& source = {});
  /// Length of the grid, samples and holes.
  [[nodiscard]] std::uint64_t length() const { return runs.empty() ? 0 : runs.back().start + runs.back().count; }
  [[nodiscard]] double duration() const { return static_cast<double>(length()) * interval; }
};

/// A signal with mean and least-squares slope removed: the input of estimators, so that a large constant causes no loss of
/// precision.
struct Detrended {
  StaticSignal signal;
  double level = 0.0;     ///< removed: value at the middle of the grid
  double slope = 0.0;     ///< per second
  double variance = 0.0;  ///< of the detrended signal
};
[[nodiscard]] Detrended detrend(const StaticSignal& signal);

/// Means of `factor` samples; a block that is not whole is a hole.
/// @param share  fraction of a block's samples that must exist; if below 1, the mean is that of the existing ones
[[nodiscard]] StaticSignal block_means(const StaticSignal& signal, std::size_t factor, double share = 1.0);

/// The samples from grid index `from` on, `length` intervals long.
[[nodiscard]] StaticSignal part_of(const StaticSignal& signal, std::uint64_t from, std::uint64_t length);

/// The signal without these samples (indices into `values`, ascending).
[[nodiscard]] StaticSignal without(const StaticSignal& signal, std::span<const std::size_t> left_out);

}  // namespace coast::noise
