#include "lag_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace coast::array {

namespace {

using Line = std::complex<double>;
using Lines = std::vector<Line>;

constexpr double kTapered = 0.1;  // of the window, at each end
constexpr Eigen::Index kLinesInBand = 32;
constexpr double kBeyondChance = 6.9;  // log of a thousand

/// A length of at least n for which the transform is fast.
Eigen::Index fast_length(Eigen::Index n) {
  for (;; ++n) {
    Eigen::Index rest = n;
    for (const Eigen::Index factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1 && n % 2 == 0) return n;
  }
}

/// Lines 0 .. n/2 of a column, zero-padded to length n.
Lines half_spectrum(const Eigen::VectorXd& column, Eigen::Index n) {
  std::vector<double> padded(static_cast<std::size_t>(n), 0.0);
  std::copy(column.begin(), column.end(), padded.begin());
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Lines lines;
  transform.fwd(lines, padded);
  return lines;
}

Eigen::VectorXd cosine_taper(Eigen::Index n) {
  Eigen::VectorXd taper = Eigen::VectorXd::Ones(n);
  const auto edge = static_cast<Eigen::Index>(kTapered * static_cast<double>(n));
  for (Eigen::Index i = 0; i < edge; ++i) {
    const double phase = std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(edge);
    taper(i) = taper(n - 1 - i) = 0.5 - 0.5 * std::cos(phase);
  }
  return taper;
}

/// Contribution of a line: weighted cross spectrum, and the noise of its imaginary part.
struct LagLine {
  double omega;  ///< rad per sample
  Line cross;    ///< W conj(A) B
  double noise;  ///< W^2 |A|^2 R/2
};

/// Coherence of a band of lines, of which `independent` are independent because of the taper.
struct Band {
  double coherence;  ///< minus its bias
  double chance;     ///< exponential of mean one if there is no common signal
  double weight;     ///< W
  double noise;      ///< R, per line
};

Band band_of(const Lines& A, const Lines& B, std::size_t from, std::size_t to, double correlated) {
  double aa = 0.0, bb = 0.0;
  Line ab = 0.0;
  for (std::size_t k = from; k < to; ++k) {
    aa += std::norm(A[k]);
    bb += std::norm(B[k]);
    ab += std::conj(A[k]) * B[k];
  }
  const double lines = static_cast<double>(to - from), independent = lines / correlated;
  const double raw = aa > 0.0 && bb > 0.0 ? std::min(std::norm(ab) / (aa * bb), 1.0 - 1e-12) : 0.0;
  Band band{};
  band.chance = -(independent - 1.0) * std::log1p(-raw);
  band.coherence = std::clamp((independent * raw - 1.0) / (independent - 1.0), 0.0, 1.0 - 1e-12);
  // Chance bands are many, and high frequencies have most weight: only coherence significant at one in a thousand is used.
  const bool counts = band.chance > kBeyondChance && band.coherence > 0.0;
  band.weight = counts ? band.coherence / (1.0 - band.coherence) * lines / std::abs(ab) : 0.0;
  band.noise = bb / lines * (1.0 - band.coherence);
  return band;
}

/// J and its two derivatives with respect to the lag.
Eigen::Vector3d correlation(const std::vector<LagLine>& lines, double lag) {
  Eigen::Vector3d J = Eigen::Vector3d::Zero();
  for (const LagLine& line : lines) {
    const Line turned = line.cross * std::polar(1.0, line.omega * lag);
    J += Eigen::Vector3d(turned.real(), -line.omega * turned.imag(), -line.omega * line.omega * turned.real());
  }
  return J;
}

/// The largest value within +-2 samples: a grid as fine as the highest frequency requires, then Newton.
double peak_lag(const std::vector<LagLine>& lines) {
  constexpr double kStep = 0.125;
  double best = 0.0, most = -1.0;
  for (double lag = -2.0; lag <= 2.0; lag += kStep) {
    const double value = correlation(lines, lag)(0);
    if (value > most) {
      most = value;
      best = lag;
    }
  }
  double lag = best;
  for (int step = 0; step < 8; ++step) {
    const Eigen::Vector3d J = correlation(lines, lag);
    if (!(J(2) < 0.0)) break;
    lag = std::clamp(lag - J(1) / J(2), best - kStep, best + kStep);
  }
  return lag;
}

}  // namespace

void detrend(LagSamples& samples) {
  const double middle = 0.5 * static_cast<double>(samples.rows() - 1);
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(samples.rows(), -middle, middle);
  samples.rowwise() -= samples.colwise().mean().eval();
  const Eigen::RowVectorXd slopes = ramp.transpose() * samples / ramp.squaredNorm();
  samples.noalias() -= ramp * slopes;
}

Eigen::Index whole_lag(const LagSamples& a, const LagSamples& b, Eigen::Index most) {
  const Eigen::Index n = fast_length(b.rows());
  Lines cross(static_cast<std::size_t>(n / 2 + 1), 0.0);
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(2 * most + 1);
  for (Eigen::Index axis = 0; axis < a.cols(); ++axis) {
    const Lines A = half_spectrum(a.col(axis), n), B = half_spectrum(b.col(axis), n);
    for (std::size_t k = 0; k < cross.size(); ++k) cross[k] += std::conj(A[k]) * B[k];
    double sum = b.col(axis).head(a.rows()).squaredNorm();
    for (Eigen::Index lag = 0; lag <= 2 * most; ++lag) {
      energy(lag) += sum;
      if (lag < 2 * most) sum += std::pow(b(lag + a.rows(), axis), 2) - std::pow(b(lag, axis), 2);
    }
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> correlations;
  transform.inv(correlations, cross, n);
  Eigen::Index best = 0;
  double largest = -1.0;
  for (Eigen::Index lag = 0; lag <= 2 * most; ++lag) {
    const double value = correlations[static_cast<std::size_t>(lag)] / std::sqrt(std::max(energy(lag), 1e-300));
    if (value <= largest) continue;
    largest = value;
    best = lag;
  }
  return best - most;
}

FineLag fine_lag(LagSamples a, LagSamples b) {
  const Eigen::Index rows = a.rows(), n = fast_length(rows);
  detrend(a);
  detrend(b);
  const Eigen::VectorXd taper = cosine_taper(rows);
  const double squares = taper.squaredNorm();
  const double correlated = static_cast<double>(rows) * taper.array().pow(4).sum() / (squares * squares);
  const double padded = static_cast<double>(n) / static_cast<double>(rows);
  std::vector<LagLine> lines;
  double chance = 0.0, bands = 0.0, coherence = 0.0, told = 0.0;
  for (Eigen::Index axis = 0; axis < a.cols(); ++axis) {
    const Lines A = half_spectrum(a.col(axis).cwiseProduct(taper), n), B = half_spectrum(b.col(axis).cwiseProduct(taper), n);
    const auto size = static_cast<std::size_t>(n / 2);
    const auto width = static_cast<std::size_t>(kLinesInBand);
    for (std::size_t from = 1; from + width <= size; from += width) {  // line 0 was subtracted, Nyquist's has no phase
      const std::size_t to = from + 2 * width <= size ? from + width : size;
      const Band band = band_of(A, B, from, to, correlated * padded);
      chance += band.chance;
      bands += 1.0;
      for (std::size_t k = from; k < to && band.weight > 0.0; ++k) {
        const double omega = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
        lines.push_back(
            {omega, band.weight * std::conj(A[k]) * B[k], 0.5 * band.weight * band.weight * std::norm(A[k]) * band.noise});
        told += omega * omega * band.weight * std::norm(A[k]);
        coherence += omega * omega * band.weight * std::norm(A[k]) * band.coherence;
      }
    }
  }
  FineLag fine;
  fine.significance = bands > 0.0 ? (chance - bands) / std::sqrt(bands) : 0.0;
  if (lines.empty()) return fine;
  fine.lag = peak_lag(lines);
  const Eigen::Vector3d J = correlation(lines, fine.lag);
  double noise = 0.0;
  for (const LagLine& line : lines) noise += line.omega * line.omega * line.noise;
  fine.sigma = std::sqrt(correlated * padded * noise) / std::max(-J(2), 1e-300);
  fine.coherence = coherence / told;
  fine.rms_frequency = std::sqrt(std::max(-J(2), 0.0) / std::max(J(0), 1e-300));
  return fine;
}

}  // namespace coast::array
