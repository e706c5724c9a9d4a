// Trends that are named and taken off: exponential and linear.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coast/noise/calibration.hpp"
#include "noise/static_record.hpp"

namespace coast::noise {
namespace {

using test::logs;
using test::sum;

constexpr double kInterval = 0.2;
constexpr std::uint64_t kLength = 9000;  // half an hour

StaticSignal with_warm_up(StaticSignal record, double amplitude, double time_constant) {
  for (std::size_t i = 0; i < record.values.size(); ++i)
    record.values[i] += 0.1 + amplitude * std::exp(-static_cast<double>(i) * record.interval / time_constant);
  return record;
}

bool says(const AxisCalibration& result, const char* words) {
  return std::ranges::any_of(result.remarks, [&](const std::string& r) { return r.find(words) != std::string::npos; });
}

// Beside white noise of density N^2 the amplitude has the variance N^2 / integral of (exp(-t/T) less its level and ramp)^2,
// some 2 N^2/T times a few for what level and ramp take: a sigma of 3 % here; the time constant's likewise.
TEST(WarmUp, IsNamedAndTheRestIsTheModels) {
  const SumModel truth = sum({"white_noise", "gauss_markov"}, Mean::kLevel);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const StaticSignal record =
        with_warm_up(realisation(truth, logs({1e-6, 0.3, 2e-6}), kInterval, kLength, seed), 0.01, 200.0);
    const AxisCalibration result = calibrate({record}, {.realisations = 60});
    EXPECT_EQ(result.best().model.name(), truth.name()) << seed;
    ASSERT_EQ(result.warm_ups.size(), 1U);
    EXPECT_NEAR(result.warm_ups[0].amplitude / 0.01, 1.0, 0.15);
    EXPECT_NEAR(result.warm_ups[0].time_constant / 200.0, 1.0, 0.25);
    EXPECT_GT(result.warm_ups[0].gain, std::log(static_cast<double>(kLength)));
    EXPECT_TRUE(says(result, "exponential trend"));
    EXPECT_TRUE(result.band.inside) << seed;
    for (std::size_t i = 0; i < result.parameters.size(); ++i)
      EXPECT_NEAR(std::log(result.parameters[i].value / std::vector{1e-6, 0.3, 2e-6}[i]), 0.0,
                  4.0 * result.parameters[i].relative_bound);
  }
}

TEST(WarmUp, IsNotSeenWhereThereIsNone) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const StaticSignal record =
        realisation(sum({"white_noise", "random_walk"}, Mean::kLevel), logs({1e-6, 1e-8}), kInterval, 4000, seed);
    EXPECT_TRUE(calibrate({record}, {.realisations = 0}).warm_ups.empty()) << seed;
  }
}

TEST(WarmUp, RecordsWithoutItAreThoseThatWereEstimatedFrom) {
  const StaticSignal flat = StaticSignal::regular(std::vector<double>(100, 2.0), 0.5);
  const std::vector<StaticSignal> rest = without_warm_ups({flat, with_warm_up(flat, 3.0, 10.0)}, {{1, 3.0, 10.0, 20.0}});
  EXPECT_EQ(rest[0].values, flat.values);
  for (const double value : rest[1].values) EXPECT_NEAR(value, 2.1, 1e-14);
}

TEST(Trend, IsNamedWhereItIsFound) {
  StaticSignal record = realisation(sum({"white_noise"}, Mean::kLevel), logs({1e-6}), kInterval, 4000, 2);
  for (std::size_t i = 0; i < record.values.size(); ++i) record.values[i] += 2e-6 * kInterval * static_cast<double>(i);
  const AxisCalibration result = calibrate({record}, {.realisations = 0});
  EXPECT_EQ(result.best().model.name(), "WN + level + DR");
  EXPECT_TRUE(says(result, "A linear trend of 0.007"));  // 0.0072 rad/s an hour, known to 3 %
}

}  // namespace
}  // namespace coast::noise
