#include "resampling_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coast::array {

namespace {

constexpr double kHalfTaps = 16.0;
/// Kaiser & Schafer (1980): 32 taps and a transition of 0.2 of the sampling frequency give 97 dB, and this beta for 97 dB.
constexpr double kBeta = 9.7;

/// Modified Bessel function of order zero by its power series; all terms are positive.
double bessel_i0(double x) {
  double term = 1.0, sum = 1.0;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= std::pow(0.5 * x / k, 2);
    sum += term;
  }
  return sum;
}

double sinc(double x) {
  const double a = std::numbers::pi * x;
  return std::abs(a) < 1e-4 ? 1.0 - a * a / 6.0 : std::sin(a) / a;
}

double kaiser(double share) {
  return bessel_i0(kBeta * std::sqrt(1.0 - share * share)) / bessel_i0(kBeta);
}

/// A windowed sinc of cutoff 0.5, per tap, and its spectrum: one up to 0.4, zero from 0.6 on.
class LowPass {
 public:
  LowPass() {
    for (int i = 1; i < kSteps; ++i) values_.push_back(sinc(kStep * i) * kaiser(kStep * i / kHalfTaps));
  }
  [[nodiscard]] double at(double frequency) const {
    double sum = 0.5, u = 0.0;
    for (const double value : values_) sum += value * std::cos(2.0 * std::numbers::pi * frequency * (u += kStep));
    return 2.0 * kStep * sum;
  }

 private:
  static constexpr int kSteps = 1024;  // trapezoids: the phase changes by 0.06 over each, and the ends are zero
  static constexpr double kStep = kHalfTaps / kSteps;
  std::vector<double> values_;
};

/// Inverse transform of the low-pass at f taps times sinc(f width)/sinc(f), f per interval of the input. The window acts on the
/// low-pass only: on the full product it would smear the curvature of the ratio of sincs, by 1e-3 of the amplitude.
class IdealKernel {
 public:
  IdealKernel(double width, double taps) {
    constexpr double kHighest = 0.65;  // per tap
    const LowPass low_pass;
    // Gauss-Legendre with three nodes in panels over which the phase changes by at most 0.8: error 0.4^6/15750 = 3e-7.
    const auto panels = static_cast<std::size_t>(8.0 * kHalfTaps * kHighest);
    const double h = kHighest / static_cast<double>(panels);
    constexpr double kOuter = 0.7745966692414834;  // sqrt(3/5)
    for (std::size_t p = 0; p < panels; ++p)
      for (const int side : {-1, 0, 1}) {
        const double f = h * (static_cast<double>(p) + 0.5 + 0.5 * kOuter * side);
        const double weight = h * (side == 0 ? 8.0 / 18.0 : 5.0 / 18.0);
        frequencies_.push_back(2.0 * std::numbers::pi * f / taps);
        gains_.push_back(2.0 * weight * low_pass.at(f) * sinc(f * width / taps) / sinc(f / taps));
      }
  }
  [[nodiscard]] double operator()(double u) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < gains_.size(); ++i) sum += gains_[i] * std::cos(frequencies_[i] * u);
    return sum;
  }

 private:
  std::vector<double> frequencies_;
  std::vector<double> gains_;
};

}  // namespace

ResamplingKernel::ResamplingKernel(double width) {
  constexpr double kPerTap = 512.0;          // entries: error of linear interpolation (pi/512)^2/24 = 2e-6 at most
  const double taps = std::max(width, 1.0);  // input intervals per interval of the lower sampling frequency
  reach_ = kHalfTaps * taps;
  per_interval_ = kPerTap / taps;
  const IdealKernel ideal(width, taps);
  const auto entries = static_cast<std::size_t>(kHalfTaps * kPerTap);
  for (std::size_t i = 0; i <= entries; ++i)
    table_.push_back(ideal(reach_ * static_cast<double>(i) / static_cast<double>(entries)));
  table_.push_back(0.0);  // so that the last entry has a successor
}

}  // namespace coast::array
