#include "coast/noise/arma_garch_study.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>

#include "noise/arma_garch_models.hpp"

namespace coast::noise {
namespace {

const ArmaGarch kStudied{.nu = 0.1, .alpha = {0.7}, .beta = {0.4}, .gamma0 = 0.2, .gamma = {0.2}, .delta = {0.5}};

TEST(ArmaGarchStudy, IntervalsHoldTheTruth) {
  std::atomic<int> calls = 0;
  const ArmaGarchStudy study = run_arma_garch_study(kStudied, 3000, 60, 11, [&](double share) {
    EXPECT_LE(share, 1.0);
    ++calls;
  });
  EXPECT_EQ(calls, 60);
  EXPECT_EQ(study.not_converged, 0U);
  EXPECT_EQ(study.without_uncertainty, 0U);
  ASSERT_EQ(study.parameters.size(), 6U);
  double pooled = 0.0;
  for (const ArmaGarchParameterSummary& p : study.parameters) {
    // 99.9 % of a mean and of a standard deviation of 60 about normal estimates; of 60 intervals 51 hold it but once in 2000.
    EXPECT_LT(std::abs(p.bias), 3.3 * p.sd / std::sqrt(60.0) + 0.1 * p.sd) << p.name;  // and some bias at 3000 samples
    EXPECT_NEAR(p.mean_se / p.sd, 1.0, 3.3 / std::sqrt(2.0 * 59.0)) << p.name;
    EXPECT_GE(p.coverage, 51.0 / 60.0) << p.name;
    EXPECT_EQ(p.coverage, static_cast<double>(p.inside) / 60.0);
    pooled += p.coverage / 6.0;
  }
  EXPECT_NEAR(study.pooled_coverage, pooled, 1e-12);
  EXPECT_NEAR(study.pooled_coverage, 0.95, 0.05);
  EXPECT_GT(study.median_seconds, 0.0);
}

TEST(ArmaGarchStudy, IsTheSameOnAnyNumberOfThreads) {
  const auto on_threads = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run_arma_garch_study(kStudied, 800, 8, 3);
  };
  const ArmaGarchStudy one = on_threads(1);
  const ArmaGarchStudy two = on_threads(2);
  for (std::size_t i = 0; i < one.parameters.size(); ++i) {
    EXPECT_EQ(one.parameters[i].bias, two.parameters[i].bias);
    EXPECT_EQ(one.parameters[i].sd, two.parameters[i].sd);
    EXPECT_EQ(one.parameters[i].mean_se, two.parameters[i].mean_se);
    EXPECT_EQ(one.parameters[i].coverage, two.parameters[i].coverage);
  }
}

TEST(ArmaGarchStudy, WithoutConstantHasOneParameterLess) {
  ArmaGarch truth = kStudied;
  truth.nu = 0.0;
  EXPECT_EQ(run_arma_garch_study(truth, 500, 2, 1, {}, false).parameters.front().name, "alpha1");
}

TEST(ArmaGarchStudy, RefusesNoRunsAndNoModel) {
  EXPECT_THROW(static_cast<void>(run_arma_garch_study(kStudied, 1000, 0, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(run_arma_garch_study({.alpha = {1.0}}, 1000, 1, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(run_arma_garch_study(kStudied, 10, 1, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace coast::noise
