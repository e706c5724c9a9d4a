#include "coast/noise/arma_garch_filter.hpp"

#include <gtest/gtest.h>

#include "noise/arma_garch_models.hpp"
#include "support/malloc_guard.hpp"

namespace coast::noise {
namespace {

double mean_square_of(const ArmaGarchResiduals& batch, const std::vector<std::uint8_t>& missing) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t < missing.size(); ++t) {
    if (!test::counts_in_likelihood(missing, t)) continue;
    sum += batch.residual[t] * batch.residual[t];
    count += 1.0;
  }
  return sum / count;
}

TEST(ArmaGarchFilter, EqualsTheBatchThroughGaps) {
  for (const ArmaGarchOrders& orders : {ArmaGarchOrders{3, 2, 1, 1}, {1, 1, 2, 2}, {0, 0, 0, 0}, {2, 0, 0, 0}, {0, 2, 2, 0}}) {
    const ArmaGarch model = test::small_arma_garch(orders);
    const std::vector<double> y = test::simulated_arma_garch(model, 500, 8);
    const std::vector<std::uint8_t> missing = test::some_missing_samples(y.size());
    const ArmaGarchResiduals batch = arma_garch_residuals(model, {y, missing});
    ArmaGarchFilter filter(model, mean_square_of(batch, missing));
    for (std::size_t t = 0; t < y.size(); ++t) {
      // Sums of a few numbers of order one, in another order.
      EXPECT_NEAR(filter.prediction().variance, batch.variance[t], 1e-12) << t;
      if (missing[t] != 0) {
        filter.miss();
        continue;
      }
      EXPECT_NEAR(y[t] - filter.prediction().mean, batch.residual[t], 1e-12) << t;
      filter.observe(y[t]);
    }
  }
}

// AR(1)-GARCH(1,1) k samples ahead: mean + alpha^k (y - mean), and s2 goes to its mean like (gamma + delta)^k.
TEST(ArmaGarchFilter, MissesAreForecasts) {
  const ArmaGarch model{.nu = 1.0, .alpha = {0.8}, .gamma0 = 0.2, .gamma = {0.2}, .delta = {0.5}};
  ArmaGarchFilter filter(model);
  EXPECT_NEAR(filter.prediction().mean, 5.0, 1e-14);
  EXPECT_NEAR(filter.prediction().variance, model.innovation_variance(), 1e-15);
  filter.observe(7.0);
  const double variance = filter.prediction().variance;
  EXPECT_NEAR(variance, 0.2 + 0.2 * 4.0 + 0.5 * model.innovation_variance(), 1e-14);
  for (int k = 1; k < 10; ++k) {
    EXPECT_NEAR(filter.prediction().mean, 5.0 + 2.0 * std::pow(0.8, k), 1e-14);
    const double away = (variance - model.innovation_variance()) * std::pow(0.7, k - 1);
    EXPECT_NEAR(filter.prediction().variance, model.innovation_variance() + away, 1e-14);
    filter.miss();
  }
  filter.reset();
  EXPECT_NEAR(filter.prediction().mean, 5.0, 1e-14);
}

TEST(ArmaGarchFilter, AllocatesNothingPerSample) {
  const ArmaGarch model = test::small_arma_garch({3, 2, 2, 2});
  ArmaGarchFilter filter(model);
  const test::MallocGuard guard;
  for (int t = 0; t < 1000; ++t) t % 10 == 0 ? filter.miss() : filter.observe(0.01 * t);
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(ArmaGarchFilter, RefusesWhatItCannotStartFrom) {
  EXPECT_THROW(ArmaGarchFilter(ArmaGarch{.alpha = {1.0}}), std::invalid_argument);
  EXPECT_THROW(ArmaGarchFilter(ArmaGarch{}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace coast::noise
