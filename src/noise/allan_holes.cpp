#include "allan_holes.hpp"

#include <cstdint>

#include "allan_curve.hpp"
#include "coast/noise/estimators.hpp"

namespace coast::noise {

namespace {

/// Integral and count of the samples from the first grid point on. The mean is subtracted, so that the integral never grows
/// large.
class Integrals {
 public:
  explicit Integrals(const StaticSignal& signal) {
    const std::size_t length = static_cast<std::size_t>(signal.length());
    double mean = 0.0;
    for (const double value : signal.values) mean += value;
    mean /= static_cast<double>(signal.values.size());
    sums_.reserve(length + 1);
    counts_.reserve(length + 1);
    sums_.push_back(0.0);
    counts_.push_back(0);
    for (const StaticSignal::Run& run : signal.runs) {
      sums_.resize(static_cast<std::size_t>(run.start) + 1, sums_.back());
      counts_.resize(static_cast<std::size_t>(run.start) + 1, counts_.back());
      for (std::size_t i = run.first; i < run.first + run.count; ++i) {
        sums_.push_back(sums_.back() + signal.values[i] - mean);
        counts_.push_back(counts_.back() + 1);
      }
    }
  }
  [[nodiscard]] std::size_t points() const { return sums_.size(); }
  [[nodiscard]] std::uint32_t count(std::size_t from, std::size_t m) const { return counts_[from + m] - counts_[from]; }
  /// m times the average of the available ones of m samples.
  [[nodiscard]] double filled(std::size_t from, std::size_t m) const {
    return (sums_[from + m] - sums_[from]) * (static_cast<double>(m) / static_cast<double>(count(from, m)));
  }

 private:
  std::vector<double> sums_;
  std::vector<std::uint32_t> counts_;
};

DifferenceSums differences_at(const Integrals& x, std::size_t m, std::size_t stride) {
  const auto least = static_cast<std::uint32_t>((3 * m + 3) / 4);
  DifferenceSums sums;
  for (std::size_t i = 0; i + 2 * m < x.points(); i += stride) {
    if (x.count(i, m) < least || x.count(i + m, m) < least) continue;
    const double last = x.filled(i + m, m);
    const double second = last - x.filled(i, m);
    sums.second += second * second;
    ++sums.second_terms;
    if (i < m || x.count(i - m, m) < least) continue;
    const double third = second - (x.filled(i, m) - x.filled(i - m, m));
    sums.third += third * third;
    ++sums.third_terms;
  }
  sums.second_runs = sums.second_terms > 0 ? 1 : 0;
  sums.third_runs = sums.third_terms > 0 ? 1 : 0;
  return sums;
}

}  // namespace

std::vector<DifferenceSums> differences_with_holes(const StaticSignal& signal, std::span<const AveragingFactor> factors,
                                                   bool full_overlap) {
  std::vector<DifferenceSums> all(factors.size());
  if (signal.values.empty()) return all;
  const Integrals x(signal);
  for (std::size_t j = 0; j < factors.size() && 2 * factors[j].samples() < x.points(); ++j)
    all[j] = differences_at(x, static_cast<std::size_t>(factors[j].samples()),
                            full_overlap ? 1 : static_cast<std::size_t>(factors[j].samples()) / factors[j].k);
  return all;
}

AllanCurve allan_curve(const StaticSignal& signal, const AllanOptions& options) {
  if (signal.values.size() < signal.length()) {
    const std::vector<AveragingFactor> factors = averaging_factors(options.points_per_decade);
    const bool full_overlap = signal.length() <= options.full_overlap_samples;
    return make_curve(signal.interval, factors, differences_with_holes(signal, factors, full_overlap), full_overlap);
  }
  AllanAccumulator accumulator(signal.interval, options);
  accumulator.add(signal.values);
  return accumulator.finish();
}

}  // namespace coast::noise
