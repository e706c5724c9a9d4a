// The band of the Allan curves of realisations of an estimate.

#include <algorithm>
#include <atomic>
#include <cmath>

#include "block_draws.hpp"
#include "calibration_checks.hpp"
#include "coast/parallel.hpp"

namespace coast::noise {

namespace {

/// Allan variances of values on the grid of a record, with its holes left out as in its own curve (allan_holes.hpp). An
/// average overlaps with at least eight others: 2 % of the information of full overlap is lost, and most of the time saved.
class GridCurve {
 public:
  GridCurve(const AllanCurve& curve, const StaticSignal& record)
      : points_(static_cast<std::size_t>(record.length()) + 1), there_(points_ - 1, false) {
    for (const AllanPoint& point : curve) factors_.push_back(static_cast<std::size_t>(point.factor));
    for (const StaticSignal::Run& run : record.runs)
      std::fill_n(there_.begin() + static_cast<std::ptrdiff_t>(run.start), run.count, true);
    if (record.values.size() + 1 == points_) return;
    counts_.push_back(0);
    for (const bool there : there_) counts_.push_back(counts_.back() + (there ? 1U : 0U));
  }

  /// Logarithms of the deviations. @param next  the value of the next grid point
  template <class Next>
  [[nodiscard]] std::vector<double> of(Next&& next) const {
    std::vector<double> x(points_, 0.0);
    for (std::size_t i = 0; i + 1 < points_; ++i) {
      const double value = next(i);
      x[i + 1] = x[i] + (there_[i] ? value : 0.0);
    }
    std::vector<double> logs;
    for (const std::size_t m : factors_) logs.push_back(0.5 * std::log(counts_.empty() ? mean(x, m) : mean_over_holes(x, m)));
    return logs;
  }

 private:
  static std::size_t stride(std::size_t m) {
    constexpr std::size_t kOverlap = 8;
    return std::max<std::size_t>(1, m / kOverlap);
  }
  [[nodiscard]] double mean(const std::vector<double>& x, std::size_t m) const {
    double sum = 0.0;
    double terms = 0.0;
    for (std::size_t i = 0; i + 2 * m < points_; i += stride(m)) {
      const double difference = (x[i + 2 * m] - x[i + m]) - (x[i + m] - x[i]);
      sum += difference * difference;
      terms += 1.0;
    }
    return sum / terms / (2.0 * static_cast<double>(m * m));
  }
  [[nodiscard]] double mean_over_holes(const std::vector<double>& x, std::size_t m) const {
    const auto least = static_cast<std::uint32_t>((3 * m + 3) / 4);
    double sum = 0.0;
    double terms = 0.0;
    for (std::size_t i = 0; i + 2 * m < points_; i += stride(m)) {
      const std::uint32_t first = counts_[i + m] - counts_[i];
      const std::uint32_t second = counts_[i + 2 * m] - counts_[i + m];
      if (first < least || second < least) continue;
      const double difference = (x[i + 2 * m] - x[i + m]) / second - (x[i + m] - x[i]) / first;
      sum += difference * difference;
      terms += 1.0;
    }
    return terms > 0.0 ? 0.5 * sum / terms : 1.0;
  }

  std::size_t points_;                 ///< of the integral
  std::vector<bool> there_;            ///< whether a grid point has a sample
  std::vector<std::uint32_t> counts_;  ///< number of samples up to a point; empty: no holes
  std::vector<std::size_t> factors_;
};

std::vector<double> on_grid(const StaticSignal& record) {
  double mean = 0.0;
  for (const double value : record.values) mean += value / static_cast<double>(record.values.size());
  std::vector<double> values(static_cast<std::size_t>(record.length()), 0.0);
  for (const StaticSignal::Run& run : record.runs)
    for (std::size_t i = 0; i < run.count; ++i)
      values[static_cast<std::size_t>(run.start) + i] = record.values[run.first + i] - mean;
  return values;
}

}  // namespace

// Most realisations leave pointwise quantiles somewhere; the largest standardised departure over all averaging times
// has one quantile within which 95 % of the realisations stay everywhere.
CurveBand band_of(const AllanCurve& curve, const SumModel& model, const std::vector<double>& u, const StaticSignal& signal,
                  double slope, const CalibrationOptions& options) {
  CurveBand band;
  const auto count = static_cast<std::size_t>(options.realisations);
  if (count < 20) return band;
  const std::size_t points = curve.size();
  const GridCurve grid(curve, signal);
  const SampleBlock block = model.block(u, signal.interval);
  std::vector<std::vector<double>> logs(count);
  std::atomic<std::size_t> done = 0;
  coast::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    BlockDraws draws(block, options.seed + 1 + i);
    if (options.progress)
      options.progress("realisations of the estimate", static_cast<double>(done++) / static_cast<double>(count));
    logs[i] = grid.of([&](std::size_t k) { return draws.next() + slope * signal.interval * static_cast<double>(k); });
  });
  std::vector<double> mean(points, 0.0);
  std::vector<double> sd(points, 0.0);
  const auto n = static_cast<double>(count);
  for (std::size_t p = 0; p < points; ++p) {
    for (const auto& one : logs) mean[p] += one[p] / n;
    for (const auto& one : logs) sd[p] += (one[p] - mean[p]) * (one[p] - mean[p]) / (n - 1.0);
    sd[p] = std::sqrt(sd[p]);
  }
  std::vector<double> largest(count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t p = 0; p < points; ++p) largest[i] = std::max(largest[i], std::abs(logs[i][p] - mean[p]) / sd[p]);
  std::ranges::sort(largest);
  const double width = largest[std::min(count - 1, static_cast<std::size_t>(std::ceil(0.95 * n)) - 1)];
  const std::vector<double> values = on_grid(signal);
  const std::vector<double> own = grid.of([&](std::size_t k) { return values[k]; });
  band.inside = true;
  for (std::size_t p = 0; p < points; ++p) {
    band.tau.push_back(curve[p].tau);
    band.lower.push_back(std::exp(mean[p] - width * sd[p]));
    band.median.push_back(std::exp(mean[p]));
    band.upper.push_back(std::exp(mean[p] + width * sd[p]));
    band.inside = band.inside && std::abs(own[p] - mean[p]) <= width * sd[p];
  }
  return band;
}

}  // namespace coast::noise
