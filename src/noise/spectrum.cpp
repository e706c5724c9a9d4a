#include "spectrum.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "kalman/fixed_model.hpp"

namespace coast::noise {

namespace {

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, kMostStates, kMostStates>;
using ComplexVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, kMostStates, 1>;

/// A length at or below n without a prime factor above five: what the transform is fast for.
std::size_t smooth_below(std::size_t n) {
  for (;; --n) {
    std::size_t rest = n;
    for (const std::size_t factor : {std::size_t{2}, std::size_t{3}, std::size_t{5}})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1 && n % 2 == 0) return n;
  }
}

/// Lines 0 .. n/2 of the periodogram under a Hann window.
std::vector<double> periodogram(const std::vector<double>& values) {
  const std::size_t n = smooth_below(values.size());
  std::vector<double> windowed(n);
  double power = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    windowed[i] = w * values[i];
    power += w * w;
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<Complex> lines;
  transform.fwd(lines, windowed);
  std::vector<double> density;
  for (const Complex& line : lines) density.push_back(std::norm(line) / power);
  return density;
}

/// Density of a sum of processes over frequency, with its slopes: y = h (z - Phi)^-1 w + v with z on the unit circle.
class Density {
 public:
  Density(const SumModel& model, const std::vector<double>& u, double interval, bool with_slopes) : interval_(interval) {
    for (const SumModel::Term& term : model.terms()) {
      const std::span<const double> own = std::span(u).subspan(term.parameter, term.parameters);
      Term& added = terms_.emplace_back();
      added.first = static_cast<Eigen::Index>(term.parameter);
      added.block = term.process->block(own, interval);
      if (with_slopes) added.slopes = term.process->derivatives(own, interval);
    }
  }

  /// @param slope  of the logarithms of parameters; empty: not wanted
  double at(double frequency, Eigen::VectorXd& slope) const {
    const Complex z = std::polar(1.0, 2.0 * std::numbers::pi * frequency * interval_);
    double sum = 0.0;
    for (const Term& term : terms_) sum += add(term, z, slope);
    return sum;
  }

 private:
  struct Term {
    Eigen::Index first = 0;
    SampleBlock block;
    std::vector<SampleBlock> slopes;
  };

  static double add(const Term& term, const Complex& z, Eigen::VectorXd& slope) {
    const SampleBlock& block = term.block;
    const Eigen::Index n = block.h.size();
    double density = block.white;
    ComplexVector g;
    ComplexVector b;
    if (n > 0) {
      ComplexMatrix A = -block.Phi.cast<Complex>();
      A.diagonal().array() += z;
      const Eigen::PartialPivLU<ComplexMatrix> factor(A);
      g = factor.transpose().solve(block.h.transpose().cast<Complex>());
      const ComplexVector driven = block.Q.cast<Complex>() * g.conjugate();
      density += (g.transpose() * driven).value().real();
      if (!term.slopes.empty()) b = factor.solve(driven);
    }
    for (std::size_t i = 0; i < term.slopes.size(); ++i) {
      const SampleBlock& d = term.slopes[i];
      double& to = slope(term.first + static_cast<Eigen::Index>(i));
      to = d.white;
      if (n == 0) continue;
      to += (g.transpose() * d.Q.cast<Complex>() * g.conjugate()).value().real();
      to += 2.0 * (g.transpose() * d.Phi.cast<Complex>() * b).value().real();
    }
    return density;
  }

  double interval_;
  std::vector<Term> terms_;
};

}  // namespace

Spectrum spectrum_of(const std::vector<Detrended>& records) {
  constexpr double kRelativeWidth = 0.01;
  constexpr double kMostBins = 1000.0;
  constexpr std::size_t kFirst = 2;  // lower lines stand in the window's shadow of level and drift
  Spectrum spectrum{records.front().signal.interval, {}};
  for (const Detrended& record : records) {
    const std::vector<double> lines = periodogram(record.signal.values);
    const double resolution = 0.5 / (static_cast<double>(lines.size() - 1) * spectrum.interval);
    const double widest = static_cast<double>(lines.size()) / kMostBins;
    for (std::size_t from = kFirst; from + 1 < lines.size();) {
      const double wanted = std::min(kRelativeWidth * static_cast<double>(from), widest);
      const std::size_t to = std::min(lines.size() - 1, from + std::max<std::size_t>(1, static_cast<std::size_t>(wanted)));
      double sum = 0.0;
      for (std::size_t k = from; k < to; ++k) sum += lines[k];
      const auto count = static_cast<double>(to - from);
      spectrum.bins.push_back(
          {(static_cast<double>(from) + 0.5 * (count - 1.0)) * resolution, count * resolution, sum / count, count});
      from = to;
    }
  }
  return spectrum;
}

double spectral_value(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u) {
  const Density density(model, u, spectrum.interval, false);
  Eigen::VectorXd none(0);
  double sum = 0.0;
  for (const Spectrum::Bin& bin : spectrum.bins) {
    const double S = density.at(bin.frequency, none);
    sum -= bin.lines * (std::log(S) + bin.density / S);
  }
  return sum;
}

LikelihoodSlope spectral_slope(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u) {
  const Density density(model, u, spectrum.interval, true);
  const auto p = static_cast<Eigen::Index>(u.size());
  LikelihoodSlope sum{0.0, Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p)};
  Eigen::VectorXd dS(p);
  for (const Spectrum::Bin& bin : spectrum.bins) {
    const double S = density.at(bin.frequency, dS);
    sum.log_likelihood -= bin.lines * (std::log(S) + bin.density / S);
    dS /= S;
    sum.gradient += bin.lines * (bin.density / S - 1.0) * dS;
    sum.information += bin.lines * dS * dS.transpose();
  }
  return sum;
}

std::optional<Band> strongest_band(const Spectrum& spectrum, const SumModel& model, const std::vector<double>& u) {
  constexpr double kSigmas = 6.0;
  constexpr double kShared = 1.94;  // neighbouring lines under a Hann window: their mean scatters by its root more
  const Density density(model, u, spectrum.interval, false);
  Eigen::VectorXd none(0);
  struct Sums {
    double excess = 0.0;  // lines times (record over sum - 1)
    double lines = 0.0;
    double variance = 0.0;
  };
  std::vector<Sums> sums(1);
  for (const Spectrum::Bin& bin : spectrum.bins) {
    const double S = density.at(bin.frequency, none);
    Sums next = sums.back();
    next.excess += bin.lines * (bin.density / S - 1.0);
    next.lines += bin.lines;
    next.variance += 2.0 * spectrum.interval * bin.width * (bin.density - S);
    sums.push_back(next);
  }
  const double widest = 0.5 / spectrum.interval / 16.0;
  std::optional<Band> best;
  for (std::size_t count = 1; count <= spectrum.bins.size(); count *= 2)
    for (std::size_t from = 0; from + count < sums.size(); ++from) {
      const Spectrum::Bin& first = spectrum.bins[from];
      const Spectrum::Bin& last = spectrum.bins[from + count - 1];
      const double width = last.frequency - first.frequency + 0.5 * (last.width + first.width);
      const double sigmas =
          (sums[from + count].excess - sums[from].excess) / std::sqrt(kShared * (sums[from + count].lines - sums[from].lines));
      // Records stand one after the other: a band does not go from one to the next.
      if (width <= 0.0 || width > widest || sigmas < kSigmas || (best && sigmas <= best->sigmas)) continue;
      best = Band{0.5 * (first.frequency + last.frequency), width, sums[from + count].variance - sums[from].variance, sigmas};
    }
  return best;
}

}  // namespace coast::noise
