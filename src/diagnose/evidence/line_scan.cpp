// Lines in the spectrum of the disturbances.

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"
#include "evidence/form_scan.hpp"

namespace coast::diagnose {

namespace {

/// A likelihood ratio of one degree of freedom as rare as a power with this ratio to its mean, which has two.
double for_one_degree(double power_ratio) {
  return noise::chi2_upper_quantile(1.0, std::clamp(std::exp(-power_ratio), 1e-290, 1.0 - 1e-12));
}

/// Squared magnitudes of the transform of a row of scores, on a uniform grid twice as long as the mission.
class Periodogram {
 public:
  explicit Periodogram(const Disturbances& d) : d_(d) {
    std::vector<double> lengths = d.length;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    step_ = std::max(*middle, (d.t.back() - d.t.front()) / 1e6);
    size_ = 2;
    while (static_cast<double>(size_) * step_ < 2.0 * (d.t.back() - d.t.front() + step_)) size_ *= 2;
    transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }
  [[nodiscard]] Eigen::ArrayXcd of(const Eigen::MatrixXf& score, Eigen::Index row) {
    std::vector<double> grid(size_, 0.0);
    for (std::size_t k = 0; k < d_.t.size(); ++k) {
      const double at = (d_.t[k] - d_.t.front() + 0.5 * d_.length[k]) / step_;
      grid[std::min(size_ - 1, static_cast<std::size_t>(at))] += score(row, static_cast<Eigen::Index>(k));
    }
    std::vector<std::complex<double>> spectrum;
    transform_.fwd(spectrum, grid);
    return Eigen::Map<Eigen::ArrayXcd>(spectrum.data(), static_cast<Eigen::Index>(spectrum.size()));
  }
  [[nodiscard]] double frequency(double bin) const { return bin / (static_cast<double>(size_) * step_); }
  [[nodiscard]] Eigen::Index bins() const { return static_cast<Eigen::Index>(size_ / 2); }

 private:
  const Disturbances& d_;
  double step_ = 0.0;
  std::size_t size_ = 0;
  Eigen::FFT<double> transform_;
};

struct Line {
  double ratio = 0.0;  ///< power over its mean by chance
  std::size_t axis = 0;
  double bin = 0.0;
  double phase = 0.0;
};

/// Offset of the vertex of the parabola through a peak and its neighbours.
double shift_of_vertex(const Eigen::ArrayXXd& ratio, Eigen::Index at) {
  if (at == 0 || at + 1 == ratio.cols()) return 0.0;
  const double curvature = ratio(0, at - 1) - 2.0 * ratio(0, at) + ratio(0, at + 1);
  return curvature < 0.0 ? 0.5 * (ratio(0, at - 1) - ratio(0, at + 1)) / curvature : 0.0;
}

/// The strongest line of an axis. @param first, bins  tested  @param largest  ratio of each draw, over all axes
Line strongest_of(std::size_t axis, const Disturbances& d, Periodogram& periodogram, Eigen::Index first, Eigen::Index bins,
                  Eigen::ArrayXd& largest) {
  Eigen::ArrayXXd power(d.score[axis].rows(), bins);
  Eigen::ArrayXcd recorded;
  for (Eigen::Index row = 0; row < power.rows(); ++row) {
    const Eigen::ArrayXcd spectrum = periodogram.of(d.score[axis], row).segment(first, bins);
    power.row(row) = spectrum.abs2().transpose();
    if (row == 0) recorded = spectrum;
  }
  const Eigen::ArrayXd mean = power.bottomRows(power.rows() - 1).colwise().mean().transpose();
  if (!(mean.minCoeff() > 0.0)) return {};
  const Eigen::ArrayXXd ratio = power.rowwise() / mean.transpose();
  largest = largest.max(ratio.bottomRows(ratio.rows() - 1).rowwise().maxCoeff());
  Eigen::Index at = 0;
  const double peak = ratio.row(0).maxCoeff(&at);
  return {peak, axis, static_cast<double>(first + at) + shift_of_vertex(ratio, at), std::arg(recorded(at))};
}

}  // namespace

std::optional<Form> strongest_line(const Examination& examination) {
  constexpr double kFewestPeriods = 4.0;
  const Disturbances& d = examination.disturbances;
  if (d.t.size() < kFewestIntervals || d.score[0].rows() < 3) return {};
  Periodogram periodogram(d);
  const double span = d.t.back() - d.t.front();
  const Eigen::Index first = static_cast<Eigen::Index>(std::ceil(kFewestPeriods / span / periodogram.frequency(1.0)));
  const Eigen::Index bins = periodogram.bins() - first;
  if (bins < 8) return {};
  Line line;
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(d.score[0].rows() - 1);
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const Line of_axis = strongest_of(axis, d, periodogram, first, bins, largest);
    if (of_axis.ratio > line.ratio) line = of_axis;
  }
  std::vector<double> ratios(static_cast<std::size_t>(largest.size()));
  std::ranges::transform(largest, ratios.begin(), for_one_degree);
  const LargestByChance chance = LargestByChance::of(std::move(ratios));
  // The phase only distributes the line between the two coefficients: they are found together.
  return Form{
      harmonic_disturbance(site_of(line.axis), static_cast<int>(line.axis % 3), periodogram.frequency(line.bin), line.phase),
      2.0 * line.ratio, chance.p_value(for_one_degree(line.ratio)), std::log(chance.count)};
}

}  // namespace coast::diagnose
