#include "processes/block_averages.hpp"

#include <cmath>
#include <complex>

namespace coast::noise {

namespace {

using Complex = std::complex<double>;

/// exp(z) - 1 without cancellation, for the tiny imaginary parts of complex steps.
Complex exp_minus_one(Complex z) {
  const double half = std::sin(0.5 * z.imag());
  return {std::expm1(z.real()) * std::cos(z.imag()) - 2.0 * half * half, std::exp(z.real()) * std::sin(z.imag())};
}

/// The numbers of the block as analytic functions of b.
struct Numbers {
  Complex phi_m, to_mean, q_state, q_cross, q_mean, first_cross, first_mean;
};

// Sums over j = 1..m of geometric series. If m b is small their closed forms lose digits as 1/(m b)^2, and the process is
// a random walk within a block to that order.
Numbers numbers(Complex b, double m) {
  const Complex lost = -exp_minus_one(-b);        // 1 - phi
  const Complex lost_m = -exp_minus_one(-m * b);  // 1 - phi^m
  const Complex lost_2m = -exp_minus_one(-2.0 * m * b);
  const Complex phi = 1.0 - lost;
  const Complex S = lost_m / lost;                  // 1 + phi + ... + phi^(m-1)
  const Complex q = -exp_minus_one(-2.0 * b);       // of one sample
  const Complex squares = phi * phi * lost_2m / q;  // phi^2 + phi^4 + ... + phi^2m
  Numbers n;
  n.phi_m = 1.0 - lost_m;
  n.to_mean = phi * S / m;
  n.q_state = lost_2m;
  n.first_cross = S / m;
  constexpr double kSmall = 1e-4;
  if (std::abs(m * b) < kSmall) {
    n.q_cross = lost_2m * (m + 1.0) / (2.0 * m);
    n.q_mean = lost_2m * (m + 1.0) * (2.0 * m + 1.0) / (6.0 * m * m);
    n.first_mean = 1.0 - b * (m * m - 1.0) / (3.0 * m);
    return n;
  }
  n.q_cross = q / (m * lost) * (S - phi * lost_2m / q);
  n.q_mean = q / (m * m * lost * lost) * (m - 2.0 * phi * S + squares);
  n.first_mean = (m + 2.0 * phi * (m * lost - lost_m) / (lost * lost)) / (m * m);
  return n;
}

template <class Part>
SampleBlock block_of(const Numbers& n, const Part& part) {
  SampleBlock block = SampleBlock::zero(2);
  block.Phi << part(n.phi_m), 0.0, part(n.to_mean), 0.0;
  block.Q << part(n.q_state), part(n.q_cross), part(n.q_cross), part(n.q_mean);
  block.P_first << part(Complex(1.0)), part(n.first_cross), part(n.first_cross), part(n.first_mean);
  return block;
}

}  // namespace

AveragedBlock averaged_gauss_markov(double b, std::size_t m) {
  constexpr double kStep = 1e-30;  // complex step: the derivative to full precision
  const Numbers n = numbers(Complex(b, b * kStep), static_cast<double>(m));
  AveragedBlock block{block_of(n, [](Complex z) { return z.real(); }),
                      block_of(n, [&](Complex z) { return z.imag() / kStep; })};
  block.value.h(1) = 1.0;
  return block;
}

AveragedVariances averaged_variances(double b, std::size_t m) {
  constexpr double kApart = 12.0;  // correlation times: `common` and `alone` cancel to exp(-12)
  const auto samples = static_cast<double>(m);
  const double variance = numbers(Complex(b), samples).first_mean.real();
  const double length = samples * b;
  if (length > kApart) return {0.0, variance};
  // The sums of phi^j and of phi^-j over a block.
  const double common = std::expm1(-length) / std::expm1(-b) * (std::expm1(length) / std::expm1(b)) / (samples * samples);
  return {common, variance - common};
}

SampleBlock averaged_random_walk(std::size_t samples) {
  const auto m = static_cast<double>(samples);
  SampleBlock block = SampleBlock::zero(2);
  block.Phi << 1.0, 0.0, 1.0, 0.0;
  const double cross = 0.5 * (m + 1.0);
  block.Q << m, cross, cross, (m + 1.0) * (2.0 * m + 1.0) / (6.0 * m);
  const double first = 0.5 * (m - 1.0);  // the first sample is zero
  block.P_first << m - 1.0, first, first, (m - 1.0) * (2.0 * m - 1.0) / (6.0 * m);
  block.h(1) = 1.0;
  return block;
}

}  // namespace coast::noise
