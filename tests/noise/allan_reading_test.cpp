// Coefficients read from simulated records whose coefficients are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "coast/noise/allan.hpp"
#include "noise/noise_samples.hpp"

namespace coast {
namespace {

using noise::AllanReading;
using noise::CoefficientReading;

AllanReading reading_of(const std::vector<double>& rates, double interval) {
  noise::AllanAccumulator accumulator(interval);
  accumulator.add(rates);
  return noise::read_coefficients(accumulator.finish());
}

void expect_inside(const std::optional<CoefficientReading>& reading, double truth, double slope) {
  ASSERT_TRUE(reading.has_value());
  EXPECT_LT(reading->interval_95.lower, truth);
  EXPECT_GT(reading->interval_95.upper, truth);
  EXPECT_LT(reading->interval_95.lower, reading->interval_68.lower);
  EXPECT_LT(reading->interval_68.upper, reading->interval_95.upper);
  EXPECT_NEAR(reading->slope, slope, 0.1);
  EXPECT_GE(reading->tau_to, 2.0 * reading->tau_from);
}

// One process in the record: its coefficient is read, and no other. White noise of variance 1 per sample at 100 Hz: N = 0.1.
TEST(AllanReading, WhiteNoiseAloneHasOnlyN) {
  const AllanReading reading = reading_of(test::white_samples(100000, 1), 0.01);
  expect_inside(reading.white_noise, 0.1, -0.5);
  EXPECT_EQ(reading.white_noise->tau_from, 0.01);
  EXPECT_FALSE(reading.quantisation || reading.bias_instability || reading.rate_random_walk || reading.rate_ramp);
}

TEST(AllanReading, RandomWalkAloneHasOnlyK) {
  const AllanReading reading = reading_of(test::random_walk_samples(100000, 0.3, 2, 0.0), 0.01);
  expect_inside(reading.rate_random_walk, 3.0, 0.5);
  EXPECT_FALSE(reading.quantisation || reading.white_noise || reading.bias_instability || reading.rate_ramp);
}

TEST(AllanReading, RampAloneHasOnlyR) {
  std::vector<double> rates(20000);
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = 0.7 * 0.01 * static_cast<double>(i);
  const AllanReading reading = reading_of(rates, 0.01);
  ASSERT_TRUE(reading.rate_ramp);
  EXPECT_NEAR(reading.rate_ramp->value, 0.7, 1e-9);  // rounding of a straight line's differences
  EXPECT_FALSE(reading.quantisation || reading.white_noise || reading.bias_instability || reading.rate_random_walk);
}

// An integral that is rounded to steps, as a counter does, with the motion taken off: Q = step / sqrt(12).
TEST(AllanReading, RoundedIntegralHasOnlyQ) {
  const double step = 1e-3, dt = 0.01;
  std::vector<double> rates;
  double exact = 0.0, error = 0.0;
  for (const double sample : test::white_samples(50000, 3)) {
    exact += 5.0 * step * sample;
    const double next = step * std::round(exact / step) - exact;
    rates.push_back((next - error) / dt);
    error = next;
  }
  const AllanReading reading = reading_of(rates, dt);
  expect_inside(reading.quantisation, step / std::sqrt(12.0), -1.0);
  EXPECT_FALSE(reading.white_noise || reading.bias_instability || reading.rate_random_walk || reading.rate_ramp);
}

// The slope of flicker noise with h/f is 0 at sqrt(2 ln 2 h), and B = sqrt(2 pi h): Kasdin's filter has h = 1/(2 pi) at
// interval 1.
TEST(AllanReading, FlickerBetweenWhiteNoiseAndWalkHasB) {
  std::vector<double> rates = test::flicker_samples(1 << 14, 4);
  const std::vector<double> white = test::white_samples(rates.size(), 5);
  const std::vector<double> walk = test::random_walk_samples(rates.size(), 0.02, 6, 0.0);
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i] += 5.0 * white[i] + walk[i];
  const AllanReading reading = reading_of(rates, 1.0);
  // Flicker noise adds to white noise wherever it is read, and a slope of -0.4 still counts: up to (0.5/0.4)^(1/2).
  ASSERT_TRUE(reading.white_noise);
  EXPECT_GT(reading.white_noise->value, 5.0);
  EXPECT_LT(reading.white_noise->value, 5.0 * std::sqrt(0.5 / 0.4));
  ASSERT_TRUE(reading.bias_instability);
  EXPECT_EQ(reading.bias_instability->tau_from, reading.bias_instability->tau_to);
  // Both neighbours raise the lowest point: by the model's own sum at that place.
  const double tau = reading.bias_instability->tau_from;
  const double raised = std::sqrt(1.0 + (25.0 / tau + 0.02 * 0.02 * tau / 3.0) * M_PI / (2.0 * std::log(2.0)));
  EXPECT_LT(reading.bias_instability->interval_95.lower, raised);
  EXPECT_GT(reading.bias_instability->interval_95.upper, raised);
}

TEST(AllanReading, NothingIsReadFromNothing) {
  const AllanReading reading = noise::read_coefficients({});
  EXPECT_FALSE(reading.white_noise || reading.quantisation || reading.bias_instability || reading.rate_random_walk ||
               reading.rate_ramp);
  EXPECT_FALSE(reading_of(std::vector<double>(1000, 9.8), 0.01).white_noise);
}

}  // namespace
}  // namespace coast
