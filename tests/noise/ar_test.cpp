// Autoregressive series: against the Yule-Walker equations, sums over all pairs, and published spectra.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "coast/record/error.hpp"
#include "noise/entries.hpp"
#include "support/spectra.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using noise::Sensor;
using test::block_of;
using test::process_of;

constexpr double kSigma = 0.3;
constexpr double kRate = 4.0;  // Hz

noise::ProcessPtr ar(const std::vector<double>& coefficients, double rate_hz = kRate) {
  std::string list;
  for (const double a : coefficients) list += fmt::format("{}{:.17g}", list.empty() ? "" : ", ", a);
  return process_of(fmt::format("{{process: ar, coefficients: [{}], innovation_sigma: {}, unit: rad/s, rate_hz: {:.17g}}}",
                                list, kSigma, rate_hz),
                    Sensor::kGyro);
}

/// R(0), ..., R(count - 1) by the Yule-Walker equations, R(n) - sum a_i R(|n - i|) = sigma^2 at n = 0 and 0 else.
std::vector<double> autocovariances(const std::vector<double>& a, std::size_t count) {
  const auto p = std::ssize(a);
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;  // poles near 1 cost their digits here
  Matrix M = Matrix::Identity(p + 1, p + 1);
  for (Eigen::Index n = 0; n <= p; ++n)
    for (Eigen::Index i = 1; i <= p; ++i) M(n, std::abs(n - i)) -= a[static_cast<std::size_t>(i - 1)];
  const Vector first = M.partialPivLu().solve(kSigma * kSigma * Vector::Unit(p + 1, 0));
  std::vector<long double> R(first.begin(), first.end());
  while (R.size() < count) {
    long double next = 0.0L;
    for (std::size_t i = 0; i < a.size(); ++i) next += a[i] * R[R.size() - 1 - i];
    R.push_back(next);
  }
  return {R.begin(), R.begin() + static_cast<std::ptrdiff_t>(count)};
}

struct Case {
  std::vector<double> coefficients;
  bool any_interval;  ///< whether a process in continuous time stands behind it
};
/// Coefficients of the series with these poles.
std::vector<double> with_poles(const std::vector<std::complex<double>>& poles) {
  std::vector<std::complex<double>> product{1.0};
  for (const auto& pole : poles) {
    product.push_back(0.0);
    for (std::size_t k = product.size() - 1; k > 0; --k) product[k] -= pole * product[k - 1];
  }
  std::vector<double> a;
  for (std::size_t k = 1; k < product.size(); ++k) a.push_back(-product[k].real());
  return a;
}
std::vector<Case> cases() {
  using namespace std::complex_literals;
  return {{{0.9}, true},
          {{0.2}, true},
          {{-0.7}, false},  // alternates: no process in continuous time does
          {with_poles({0.99, 0.9}), true},
          {{1.2, -0.5}, true},                                                   // a damped oscillation of eleven samples
          {with_poles({0.95 * std::exp(2.9i), 0.95 * std::exp(-2.9i)}), false},  // one of two samples
          {with_poles({0.999, 0.97, 0.6}), true},
          {with_poles({0.98, 0.9 * std::exp(0.3i), 0.9 * std::exp(-0.3i)}), true},
          {with_poles({0.99 * std::exp(0.1i), 0.99 * std::exp(-0.1i), 0.8 * std::exp(0.7i), 0.8 * std::exp(-0.7i)}), true},
          {{0.5, 0.3}, false},     // a negative pole beside a positive one
          {{1.8, -0.81}, false}};  // twice the same pole: modes cannot be told apart
}

TEST(Ar, AutocovarianceAtWholeSamplesIsYuleAndWalkers) {
  for (const Case& c : cases()) {
    const auto process = ar(c.coefficients);
    const auto R = autocovariances(c.coefficients, 200);
    for (const std::size_t lag : {0U, 1U, 2U, 3U, 7U, 50U, 199U}) {
      const auto block = block_of(*process, std::max(1e-12, static_cast<double>(lag) / kRate));
      // The factorisation is believed to 1e-9 of the variance; these reach 1e-11.
      EXPECT_NEAR((block.h * block.Phi * block.P * block.h.transpose())(0, 0), R[lag], 1e-11 * R[0])
          << process->yaml() << " lag " << lag;
    }
  }
}

TEST(Ar, CovarianceIsStationaryOverWholeSamplesAndDrivenByNothingNegative) {
  for (const Case& c : cases()) {
    const auto process = ar(c.coefficients);
    for (const double samples : {1.0, 2.0, 5.0, 100.0}) {
      const auto block = block_of(*process, samples / kRate);
      test::expect_near_matrix(block.Phi * block.P * block.Phi.transpose() + block.Q_d, block.P, 1e-11, process->yaml());
      const double lowest = test::eigenvalues(block.Q_d).minCoeff();
      EXPECT_GE(lowest, -1e-13 * block.Q_d.norm()) << process->yaml();
    }
  }
}

// Where a process in continuous time stands behind the series, every interval is as good as another.
TEST(Ar, HalfIntervalsMakeAWholeWhereAContinuousProcessExists) {
  for (const Case& c : cases()) {
    const auto process = ar(c.coefficients);
    if (!c.any_interval) continue;
    for (const double dt : {0.001, 0.25, 0.33, 20.0}) {
      const auto whole = block_of(*process, dt), half = block_of(*process, 0.5 * dt);
      test::expect_near_matrix(half.Phi * half.Phi, whole.Phi, 1e-14, process->yaml());
      test::expect_near_matrix(half.Phi * half.Q_d * half.Phi.transpose() + half.Q_d, whole.Q_d, 1e-12, process->yaml());
      test::expect_near_matrix(whole.Phi * whole.P * whole.Phi.transpose() + whole.Q_d, whole.P, 1e-12, process->yaml());
    }
  }
}

// Where none does, an interval is the nearest number of steps of the companion form.
TEST(Ar, WholeStepsElsewhere) {
  for (const Case& c : cases()) {
    if (c.any_interval) continue;
    const auto process = ar(c.coefficients);
    const auto p = std::ssize(c.coefficients);
    const auto nothing = block_of(*process, 0.49 / kRate), one = block_of(*process, 1.4 / kRate);
    EXPECT_EQ(nothing.Phi, Eigen::MatrixXd::Identity(p, p)) << process->yaml();
    EXPECT_TRUE(nothing.Q_d.isZero(0.0));
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(p, p), Q = A;
    for (Eigen::Index i = 0; i < p; ++i) A(0, i) = c.coefficients[static_cast<std::size_t>(i)];
    for (Eigen::Index i = 1; i < p; ++i) A(i, i - 1) = 1.0;
    Q(0, 0) = kSigma * kSigma;
    EXPECT_EQ(one.Phi, A) << process->yaml();
    test::expect_near_matrix(one.Q_d, Q, 1e-15, "Q_d");
    const auto three = block_of(*process, 3.0 / kRate);
    test::expect_near_matrix(three.Phi, A * A * A, 1e-14, "Phi");
    test::expect_near_matrix(three.Q_d, A * (A * Q * A.transpose() + Q) * A.transpose() + Q, 1e-14, "Q_d");
  }
}

TEST(Ar, FirstOrderIsGaussMarkov) {
  const double a = 0.9, sigma = kSigma / std::sqrt(1.0 - a * a), time = -1.0 / (kRate * std::log(a));
  const auto markov = process_of(
      fmt::format("{{process: gauss_markov, sigma: {:.17g}, unit: rad/s, correlation_time_s: {:.17g}}}", sigma, time),
      Sensor::kGyro);
  const auto process = ar({a});
  for (const double dt : {0.01, 0.25, 3.3}) {
    const auto one = block_of(*process, dt), other = block_of(*markov, dt);
    EXPECT_NEAR(one.Phi(0, 0), other.Phi(0, 0), 1e-14);
    EXPECT_NEAR(one.Q_d(0, 0) * one.h(0) * one.h(0), other.Q_d(0, 0), 1e-13 * other.Q_d(0, 0));
  }
}

/// Allan (two) or Hadamard (three intervals) variance of means over m by the sum over all pairs of samples.
double by_all_pairs(const std::vector<double>& R, std::size_t m, const std::vector<double>& weights, double divisor) {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size() * m; ++i)
    for (std::size_t j = 0; j < weights.size() * m; ++j) sum += weights[i / m] * weights[j / m] * R[i > j ? i - j : j - i];
  return sum / (divisor * static_cast<double>(m * m));
}

TEST(Ar, VariancesAreTheSumOverAllPairs) {
  for (const Case& c : cases()) {
    const auto process = ar(c.coefficients);
    const auto R = autocovariances(c.coefficients, 1000);
    for (const std::size_t m : {1U, 2U, 3U, 10U, 64U, 321U}) {
      const double tau = static_cast<double>(m) / kRate;
      const double allan = by_all_pairs(R, m, {1.0, -1.0}, 2.0), third = by_all_pairs(R, m, {1.0, -2.0, 1.0}, 6.0);
      // The pairs' own cancellation against R(0).
      EXPECT_NEAR(*process->allan_variance(tau), allan, 1e-11 * allan + 1e-12 * R[0]) << process->yaml() << " " << m;
      EXPECT_NEAR(*process->hadamard_variance(tau), third, 1e-11 * third + 1e-12 * R[0]) << process->yaml() << " " << m;
    }
  }
}

// Far beyond the correlation time: white noise of the density at frequency zero, sigma^2/(1 - sum a)^2 a sample. What remains
// is of the order of correlation time over tau.
TEST(Ar, LongMeansAreThoseOfWhiteNoise) {
  for (const Case& c : cases()) {
    double left = 1.0;
    for (const double a : c.coefficients) left -= a;
    const double m = 1e9, expected = std::pow(kSigma / left, 2) / m;
    EXPECT_NEAR(*ar(c.coefficients)->allan_variance(m / kRate), expected, 1e-5 * expected);
    EXPECT_NEAR(*ar(c.coefficients)->hadamard_variance(m / kRate), expected, 1e-5 * expected);
  }
}

// A pole within 1e-9 of 1 is a random walk to everybody: differences of neighbours have variance sigma^2 2/(1 + a), held values
// over m samples sigma^2 (2 m^2 + 1)/(6 m), as sums of squares of the triangle 1, 2, .., m, .., 2, 1 give.
TEST(Ar, KeepsItsDigitsNearAPoleOfOne) {
  const auto process = ar({1.0 - 1e-9});
  EXPECT_NEAR(*process->allan_variance(1.0 / kRate), kSigma * kSigma / (2.0 - 1e-9), 1e-14);
  const double m = 100.0, expected = kSigma * kSigma * (2.0 * m * m + 1.0) / (6.0 * m);
  EXPECT_NEAR(*process->allan_variance(m / kRate), expected, 1e-6 * expected);
}

TEST(Ar, SaysWhereItRings) {
  // Poles 0.95 exp(+-0.3i) at 4 Hz: 0.3 * 4 / (2 pi) Hz and -log 0.95 * 4 / pi Hz; rms by Yule and Walker's closed form for
  // order 2, sigma^2 (1 - a2) / ((1 + a2)((1 - a2)^2 - a1^2)).
  const double a1 = 2.0 * 0.95 * std::cos(0.3);
  const double a2 = -0.9025;
  const double rms = kSigma * std::sqrt((1.0 - a2) / ((1.0 + a2) * ((1.0 - a2) * (1.0 - a2) - a1 * a1)));
  EXPECT_EQ(ar({a1, a2})->in_words(), fmt::format("AR(2) rings at 0.191 Hz (0.0653 Hz wide), rms {:.3g} rad/s", rms));
  EXPECT_EQ(ar({0.5, 0.1})->in_words(), "");
}

TEST(Ar, VarianceIsInterpolatedBetweenWholeSamples) {
  const auto process = ar({0.9});
  const double one = *process->allan_variance(1.0 / kRate), two = *process->allan_variance(2.0 / kRate);
  EXPECT_NEAR(*process->allan_variance(0.3 / kRate), 0.3 * one, 1e-14);
  EXPECT_NEAR(*process->allan_variance(1.25 / kRate), 0.75 * one + 0.25 * two, 1e-14);
}

TEST(Ar, WhatIsNotStationaryIsRefused) {
  for (const std::vector<double>& a : {std::vector<double>{1.0}, {-1.0}, {1.7, -0.6}, {1.0, -1.0}, {0.5, 0.5}}) {
    try {
      (void)ar(a);
      ADD_FAILURE() << a.front();
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("not stationary"), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW((void)ar({}), InputError);
  EXPECT_THROW((void)ar({0.5, 0.0}), InputError);
  EXPECT_THROW((void)ar({0.5}, 0.0), InputError);
  EXPECT_THROW((void)ar(std::vector<double>(13, 0.01)), InputError);
}

}  // namespace
}  // namespace coast
