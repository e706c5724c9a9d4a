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

/// A length of at most n without a prime factor above five, for which the transform is fast.
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

/// A point on the unit circle: z = exp(i omega), and the square of its distance from 1, without cancellation.
struct Phasor {
  explicit Phasor(double omega) : z(std::polar(1.0, omega)), square(4.0 * std::sin(0.5 * omega) * std::sin(0.5 * omega)) {}
  Complex z;
  double square;
};

/// States without coupling: a sum of h^2 Q / |z - phi|^2.
class ScalarStates {
 public:
  static bool apply_to(const SampleBlock& block) { return block.Phi.isDiagonal(0.0) && block.Q.isDiagonal(0.0); }

  static double density(const SampleBlock& block, const Phasor& at) {
    double sum = block.white;
    for (Eigen::Index i = 0; i < block.h.size(); ++i)
      sum += block.h(i) * block.h(i) * block.Q(i, i) / distance(block.Phi(i, i), at);
    return sum;
  }
  static double slope(const SampleBlock& block, const SampleBlock& d, const Phasor& at) {
    double sum = d.white;
    for (Eigen::Index i = 0; i < block.h.size(); ++i) {
      const double lost = 1.0 - block.Phi(i, i);
      const double from = distance(block.Phi(i, i), at);
      const double change = d.Phi(i, i) * (at.square - 2.0 * lost);  // of `from`
      sum += block.h(i) * block.h(i) / from * (d.Q(i, i) - block.Q(i, i) * change / from);
    }
    return sum;
  }

 private:
  /// |z - phi|^2 = (1 - phi)^2 + phi |z - 1|^2
  static double distance(double phi, const Phasor& at) { return (1.0 - phi) * (1.0 - phi) + phi * at.square; }
};

/// Spectral density of a sum of processes, with its slopes: y = h (z - Phi)^-1 w + v with z on the unit circle.
class Density {
 public:
  Density(const SumModel& model, const std::vector<double>& u, double interval, bool with_slopes) : interval_(interval) {
    for (const SumModel::Term& term : model.terms()) {
      const std::span<const double> own = std::span(u).subspan(term.parameter, term.parameters);
      Term& added = terms_.emplace_back();
      added.first = static_cast<Eigen::Index>(term.parameter);
      added.block = term.process->block(own, interval);
      added.scalar = ScalarStates::apply_to(added.block);
      if (!with_slopes) continue;
      added.slopes = term.process->derivatives(own, interval);
      for (const SampleBlock& d : added.slopes) added.sparse.push_back({d.white, elements(d.Phi), elements(d.Q)});
    }
  }

  /// @param slope  with respect to the logarithms of parameters; empty: not computed
  double at(double frequency, Eigen::VectorXd& slope) const {
    const Phasor place(2.0 * std::numbers::pi * frequency * interval_);
    double sum = 0.0;
    for (const Term& term : terms_) sum += term.scalar ? add_scalar(term, place, slope) : add(term, place.z, slope);
    return sum;
  }

 private:
  struct Element {
    Eigen::Index row = 0;
    Eigen::Index col = 0;
    double value = 0.0;
  };
  /// A derivative by one parameter: few elements of a block depend on it.
  struct Slope {
    double white = 0.0;
    std::vector<Element> Phi;
    std::vector<Element> Q;
  };
  struct Term {
    Eigen::Index first = 0;
    SampleBlock block;
    std::vector<SampleBlock> slopes;
    std::vector<Slope> sparse;  ///< the same
    bool scalar = false;
  };

  static std::vector<Element> elements(const Eigen::MatrixXd& matrix) {
    std::vector<Element> all;
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      for (Eigen::Index r = 0; r < matrix.rows(); ++r)
        if (matrix(r, c) != 0.0) all.push_back({r, c, matrix(r, c)});
    return all;
  }
  static double add_scalar(const Term& term, const Phasor& place, Eigen::VectorXd& slope) {
    for (std::size_t i = 0; i < term.slopes.size(); ++i)
      slope(term.first + static_cast<Eigen::Index>(i)) = ScalarStates::slope(term.block, term.slopes[i], place);
    return ScalarStates::density(term.block, place);
  }
  static double add(const Term& term, const Complex& z, Eigen::VectorXd& slope) {
    switch (term.block.h.size()) {
      case 2:
        return add_sized<2>(term, z, slope);
      case 3:
        return add_sized<3>(term, z, slope);
      case 4:
        return add_sized<4>(term, z, slope);
      default:
        return add_sized<Eigen::Dynamic>(term, z, slope);
    }
  }
  template <int N>
  static double add_sized(const Term& term, const Complex& z, Eigen::VectorXd& slope) {
    constexpr int kMost = N == Eigen::Dynamic ? kMostStates : N;
    using Square = Eigen::Matrix<Complex, N, N, 0, kMost, kMost>;
    using Column = Eigen::Matrix<Complex, N, 1, 0, kMost, 1>;
    const SampleBlock& block = term.block;
    Square A = -block.Phi.cast<Complex>();
    A.diagonal().array() += z;
    const Square inverse = A.inverse();
    const Column g = inverse.transpose() * block.h.transpose().cast<Complex>();
    const Column driven = block.Q.cast<Complex>() * g.conjugate();
    const double density = block.white + (g.transpose() * driven).value().real();
    if (term.sparse.empty()) return density;
    const Column b = inverse * driven;
    for (std::size_t i = 0; i < term.sparse.size(); ++i) {
      double sum = term.sparse[i].white;
      for (const Element& e : term.sparse[i].Q) sum += e.value * (g(e.row) * std::conj(g(e.col))).real();
      for (const Element& e : term.sparse[i].Phi) sum += 2.0 * e.value * (g(e.row) * b(e.col)).real();
      slope(term.first + static_cast<Eigen::Index>(i)) = sum;
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
  constexpr std::size_t kFirst = 2;  // lower lines are affected by level and drift through the window
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
  constexpr double kShared = 1.94;  // variance factor of a mean of lines: under a Hann window neighbours are correlated
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
      // Records follow each other: a band does not extend from one to the next.
      if (width <= 0.0 || width > widest || sigmas < kSigmas || (best && sigmas <= best->sigmas)) continue;
      best = Band{0.5 * (first.frequency + last.frequency), width, sums[from + count].variance - sums[from].variance, sigmas};
    }
  return best;
}

}  // namespace coast::noise
