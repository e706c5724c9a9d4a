// Long simulated series of the processes of the error model: their Allan and Hadamard curves against the closed forms, and what
// rounding leaves.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "coast/noise/allan.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/simulate/sensor_errors.hpp"
#include "sensor.hpp"
#include "support/support.hpp"

namespace coast::simulate {
namespace {

using Eigen::Vector3d;

noise::ProcessPtr process(const std::string& gyro) {
  return error_model(gyro).axes(noise::Sensor::kGyro)[0].front();
}

/// The power law that the model's own curve follows about tau, by its slope over two octaves.
noise::NoiseType noise_about(const noise::Process& process, double tau) {
  const double slope = std::log2(*process.allan_variance(2.0 * tau) / *process.allan_variance(0.5 * tau)) / 2.0;
  return static_cast<noise::NoiseType>(std::clamp(std::lround(slope), -2L, 2L) + 2);
}

/// Every point of both curves inside chi-square bounds that all of them together keep with 95 %. Degrees of freedom are those
/// of the model's power law: what a few averages at the end of the record look like is no guide.
void expect_curves(const noise::AllanCurve& curve, const noise::Process& process, double shortest) {
  const auto inside = [&](const noise::AllanPoint& point, const noise::Deviation& deviation, int order, double variance) {
    const double edf = noise::degrees_of_freedom(
        noise_about(process, point.tau),
        {.order = order, .factor = point.factor, .stride = point.factor / point.overlap, .terms = deviation.terms, .runs = 1});
    const double tail = 0.05 / (4.0 * static_cast<double>(curve.size()));
    const double chi2 = edf * deviation.value * deviation.value / variance;
    EXPECT_LT(chi2, noise::chi2_upper_quantile(edf, tail)) << order << " " << process.yaml() << " at " << point.tau;
    EXPECT_GT(chi2, noise::chi2_upper_quantile(edf, 1.0 - tail)) << order << " " << process.yaml() << " at " << point.tau;
  };
  for (const noise::AllanPoint& point : curve) {
    if (point.tau < shortest) continue;
    inside(point, point.allan, 2, *process.allan_variance(point.tau));
    inside(point, point.hadamard, 3, *process.hadamard_variance(point.tau));
  }
}

noise::AllanCurve simulated(const noise::ProcessPtr& process, double dt, int samples, std::uint64_t seed) {
  Realisation realisation(process, seed);
  noise::AllanAccumulator accumulator(dt);
  for (int k = 0; k < samples; ++k) accumulator.add(realisation.next(dt));
  return accumulator.finish();
}

// At its own rate a series is what its coefficients say, sample by sample: slow, oscillating, alternating. The slow one is
// smooth over 100 samples: up to there its differences have fewer degrees of freedom than those of any power law.
TEST(Simulated, AutoregressiveSeriesFollowTheirCurves) {
  const std::pair<const char*, double> all[] = {
      {"1.989, -0.98901", 50.0}, {"1.2, -0.5", 0.0}, {"-0.7", 0.0}, {"0.5, 0.3", 0.0}};
  for (const auto& [coefficients, shortest] : all) {
    const auto ar = process(
        fmt::format("{{process: ar, coefficients: [{}], innovation_sigma: 0.01, unit: rad/s, rate_hz: 4}}", coefficients));
    expect_curves(simulated(ar, 0.25, 400000, 5), *ar, shortest);
  }
}

// Intervals that are no samples of the series see each value for as long as it is held: five of 0.4 s cover two of 1 s.
TEST(Simulated, AutoregressiveSeriesAreHeldBetweenTheirOwnSamples) {
  const auto ar = process("{process: ar, coefficients: [0.9], innovation_sigma: 0.01, unit: rad/s, rate_hz: 1}");
  Realisation own(ar, 3), other(ar, 3);
  for (int k = 0; k < 1000; ++k) {
    const double first = own.next(1.0), second = own.next(1.0);
    double sum = 0.0, parts[5];
    for (double& part : parts) sum += 0.4 * (part = other.next(0.4));
    EXPECT_NEAR(parts[0], first, 1e-15);
    EXPECT_NEAR(parts[1], first, 1e-15);
    EXPECT_NEAR(parts[2], 0.5 * (first + second), 1e-15);
    EXPECT_NEAR(parts[4], second, 1e-15);
    EXPECT_NEAR(sum, first + second, 1e-14);
  }
}

// Two days at 5 Hz of a floor from 10 to 1000 s.
TEST(Simulated, FlickerFollowsItsCurve) {
  const auto flicker = process("{process: flicker, coefficient: 0.01, unit: rad/s, shortest_time_s: 10, longest_time_s: 1000}");
  // At a few samples the mean of an interval's ends is not that of the interval.
  expect_curves(simulated(flicker, 0.2, 900000, 8), *flicker, 2.0);
}

TEST(Simulated, DriftIsTheSameInEveryRunAndARampIsDrawn) {
  const double R = 2e-3;
  double sum = 0.0;
  const int runs = 400;
  for (int seed = 0; seed < runs; ++seed) {
    Realisation drift(process("{process: drift, slope: -0.5, unit: rad/s^2}"), static_cast<std::uint64_t>(seed));
    EXPECT_NEAR(drift.next(0.2), -0.05, 1e-16);  // the mean is that of the middle
    EXPECT_NEAR(drift.next(0.2), -0.15, 1e-16);
    Realisation ramp(process("{process: rate_ramp, coefficient: 2e-3, unit: rad/s^2}"), static_cast<std::uint64_t>(seed));
    const double first = ramp.next(0.2), second = ramp.next(0.2), third = ramp.next(0.2);
    EXPECT_NEAR(second, 3.0 * first, 1e-14);
    EXPECT_NEAR(third, 5.0 * first, 1e-14);
    sum += first * first;
  }
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(1.0, runs);
  EXPECT_GT(sum / runs, R * R * 0.01 * bounds.lower);
  EXPECT_LT(sum / runs, R * R * 0.01 * bounds.upper);
}

constexpr const char* kWhite = "{process: white_noise, density: 1e-3, unit: rad/s/sqrt(Hz)}";

// The output's integral lies on a grid and stays within a step of the unrounded one to the end: nothing accumulates. The noise
// moves it by ten steps a sample, so the errors at different times are independent and the curve is that of IEEE 952.
TEST(Simulated, RoundedIntegralNeverLosesTheResidue) {
  const double dt = 0.01, step = 1e-5;
  const record::ImuRecording truth = constant_truth(1000000, dt, {1e-3, 0.0, -0.02}, Vector3d::Zero());
  const auto rounded_model = error_model(fmt::format("{}, {{process: quantisation, step: {}, unit: rad}}", kWhite, step));
  const record::ImuRecording smooth = with_errors(truth, error_model(kWhite), 9),
                             rounded = with_errors(truth, rounded_model, 9);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    noise::AllanAccumulator accumulator(dt);
    double error = 0.0, largest = 0.0, off_grid = 0.0;
    for (std::size_t k = 0; k < truth.samples.size(); ++k) {
      const double value = rounded.samples[k].dtheta(axis), difference = value - smooth.samples[k].dtheta(axis);
      accumulator.add_increment(difference);
      error += difference;
      largest = std::max(largest, std::abs(error));
      off_grid = std::max(off_grid, std::abs(value / step - std::round(value / step)));
    }
    EXPECT_LE(largest, step * (1.0 + 1e-6));  // half a step where it began, half a step now; rounding of 1e6 sums
    EXPECT_GT(largest, 0.49 * step);
    EXPECT_LT(off_grid, 1e-9);
    expect_curves(accumulator.finish(), *rounded_model.axes(noise::Sensor::kGyro)[0].back(), 0.0);
  }
}

// Each sample by itself: white noise of step^2/12, here beside a signal that the noise spreads over two steps and more.
TEST(Simulated, RoundedSamplesCarryWhiteNoise) {
  const double dt = 0.01, step = 5e-3;
  const record::ImuRecording truth = constant_truth(300000, dt, {0.0, 0.0123, 0.0}, Vector3d::Zero());
  const auto rounded_model = error_model(fmt::format("{}, {{process: quantisation, step: {}, unit: rad/s}}", kWhite, step));
  const record::ImuRecording smooth = with_errors(truth, error_model(kWhite), 4),
                             rounded = with_errors(truth, rounded_model, 4);
  noise::AllanAccumulator accumulator(dt);
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    const double value = rounded.samples[k].dtheta.y() / dt, difference = value - smooth.samples[k].dtheta.y() / dt;
    EXPECT_LE(std::abs(difference), 0.5 * step * (1.0 + 1e-12));
    EXPECT_NEAR(value / step, std::round(value / step), 1e-9);
    accumulator.add(difference);
  }
  expect_curves(accumulator.finish(), *rounded_model.axes(noise::Sensor::kGyro)[1].back(), 0.0);
}

}  // namespace
}  // namespace coast::simulate
