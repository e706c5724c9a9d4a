#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/LU>
#include <functional>
#include <numeric>

#include "noise/arma_garch_models.hpp"

namespace coast::noise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(ArmaGarchFit, OfWhiteNoiseIsTheClosedForm) {
  std::vector<double> y = test::simulated_arma_garch({.nu = 9.81, .gamma0 = 4e-6}, 3000, 1);
  const Eigen::Map<const Eigen::ArrayXd> all(y.data(), std::ssize(y));
  const Eigen::ArrayXd e = all - all.mean();
  const double variance = e.square().mean();
  const double fourth = e.square().square().mean();
  const ArmaGarchFit fit = fit_arma_garch({y}, {});
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.parameters, 2);
  EXPECT_EQ(fit.observations, 3000U);
  const double sd = std::sqrt(variance / 3000.0);
  EXPECT_NEAR(fit.model.nu, all.mean(), 2e-5 * sd);  // where 1e-10 of log-likelihood is left
  EXPECT_NEAR(fit.model.gamma0, variance, 1e-6 * variance);
  EXPECT_NEAR(fit.log_likelihood, -1500.0 * (std::log(2.0 * M_PI * variance) + 1.0), 1e-8);
  EXPECT_NEAR(fit.aic(), 4.0 - 2.0 * fit.log_likelihood, 1e-9);
  EXPECT_NEAR(fit.aicc() - fit.aic(), 12.0 / 2997.0, 1e-9);
  // Of the mean s2/n, of the variance (m4 - s2^2)/n, whatever the distribution; for a normal one 2 s2^2/n.
  const ArmaGarchUncertainty sds = arma_garch_uncertainty(fit, {y}).value();
  EXPECT_NEAR(sds.robust_sd(0), sd, 1e-4 * sd);
  EXPECT_NEAR(sds.robust(1, 1), (fourth - variance * variance) / 3000.0, 1e-4 * sds.robust(1, 1));
  EXPECT_NEAR(sds.curvature(1, 1), 2.0 * variance * variance / 3000.0, 1e-4 * sds.curvature(1, 1));
  const std::vector<Interval> intervals = arma_garch_intervals(fit, sds);
  EXPECT_NEAR(intervals[0].upper - intervals[0].lower, 2.0 * 1.959964 * sd, 1e-3 * sd);
}

TEST(ArmaGarchFit, FindsTheModelThatSimulated) {
  const ArmaGarch truth = test::separated_arma_garch();
  const VectorXd theta = arma_garch_vector(truth, true);
  for (const bool with_gaps : {false, true}) {
    const std::vector<double> y = test::simulated_arma_garch(truth, 20000, 2);
    std::vector<std::uint8_t> missing(y.size(), 0);
    for (std::size_t t = 0; with_gaps && t < y.size(); ++t) missing[t] = t % 500 < 20 ? 1 : 0;
    const ArmaGarchSeries series{y, missing};
    const ArmaGarchFit fit = fit_arma_garch(series, truth.orders());
    EXPECT_TRUE(fit.converged);
    EXPECT_GT(fit.log_likelihood, arma_garch_log_likelihood(truth, series));
    EXPECT_NEAR(fit.log_likelihood, arma_garch_log_likelihood(fit.model, series), 1e-7);
    EXPECT_NEAR(fit.nearest_root_pair.value(), truth.nearest_root_pair().value(), 0.1);
    const ArmaGarchUncertainty sds = arma_garch_uncertainty(fit, series).value();
    const VectorXd found = arma_garch_vector(fit.model, true);
    const VectorXd gradient = arma_garch_gradient(fit.model, series);
    for (Index i = 0; i < found.size(); ++i) {
      EXPECT_LT(std::abs(found(i) - theta(i)), 4.0 * sds.robust_sd(i)) << i;  // one in 15000
      // 1e-10 of log-likelihood is 1.4e-5 deviations in the best known direction; a parameter correlated with others sees more.
      EXPECT_LT(std::abs(gradient(i)) * sds.robust_sd(i), 5e-4) << i;
    }
    // Twice what the truth lacks is chi2(9).
    EXPECT_LT(2.0 * (fit.log_likelihood - arma_garch_log_likelihood(truth, series)), 28.0);
  }
}

/// Second derivatives of the terms' sum and outer products of their first ones, all by differences of the terms as written.
struct SandwichByDifferences {
  MatrixXd robust;
  MatrixXd curvature;
};
SandwichByDifferences sandwich_by_differences(const ArmaGarchFit& fit, const ArmaGarchSeries& series, const VectorXd& sds) {
  const VectorXd theta = arma_garch_vector(fit.model, fit.options.constant);
  const Index k = theta.size();
  const auto terms = [&](const VectorXd& away) {
    const ArmaGarch at = arma_garch_model(fit.model.orders(), fit.options.constant, theta + away.cwiseProduct(sds));
    const std::vector<double> all = test::terms_as_written(at, series, fit.options.start);
    return VectorXd(Eigen::Map<const VectorXd>(all.data(), std::ssize(all)));
  };
  // In deviations: h^2 of the Hessian's change and 1e-12 of rounding over h^2.
  constexpr double kStep = 2e-2;
  const auto unit = [&](Index i) { return VectorXd(kStep * VectorXd::Unit(k, i)); };
  MatrixXd A(k, k);
  MatrixXd scores(std::ssize(series.y), k);
  for (Index i = 0; i < k; ++i) {
    scores.col(i) = (terms(unit(i)) - terms(-unit(i))) / (2.0 * kStep);
    for (Index j = 0; j < k; ++j)
      A(i, j) =
          -(terms(unit(i) + unit(j)) - terms(unit(i) - unit(j)) - terms(unit(j) - unit(i)) + terms(-unit(i) - unit(j))).sum() /
          (4.0 * kStep * kStep);
  }
  const MatrixXd inverse = A.inverse();
  const MatrixXd robust = inverse * scores.transpose() * scores * inverse;
  return {sds.asDiagonal() * robust * sds.asDiagonal(), sds.asDiagonal() * inverse * sds.asDiagonal()};
}

TEST(ArmaGarchFit, RobustDeviationsAreThoseByDifferences) {
  const ArmaGarch truth = test::separated_arma_garch();
  // Residuals with heavier tails than normal ones have: the two covariances differ.
  std::vector<double> y = test::simulated_arma_garch(truth, 4000, 5);
  for (std::size_t t = 50; t < y.size(); t += 97) y[t] += t % 2 == 0 ? 3.0 : -3.0;
  std::vector<std::uint8_t> missing = test::some_missing_samples(y.size());
  for (const bool constant : {true, false}) {
    const ArmaGarchSeries series{y, missing};
    const ArmaGarchFit fit = fit_arma_garch(series, truth.orders(), {.constant = constant});
    const ArmaGarchUncertainty sds = arma_garch_uncertainty(fit, series).value();
    const VectorXd stated = sds.robust.diagonal().cwiseSqrt();
    const SandwichByDifferences expected = sandwich_by_differences(fit, series, sds.curvature.diagonal().cwiseSqrt());
    for (Index i = 0; i < stated.size(); ++i) {
      const double robust = std::sqrt(expected.robust(i, i));
      const double curvature = std::sqrt(expected.curvature(i, i));
      EXPECT_NEAR(stated(i), robust, 2e-3 * robust) << i;
      EXPECT_NEAR(std::sqrt(sds.curvature(i, i)), curvature, 2e-3 * curvature) << i;
    }
    EXPECT_GT(stated(stated.size() - 2), 1.1 * std::sqrt(sds.curvature(stated.size() - 2, stated.size() - 2)));
  }
}

TEST(ArmaGarchFit, MovesWithLevelAndUnit) {
  const ArmaGarch truth = test::separated_arma_garch();
  const std::vector<double> y = test::simulated_arma_garch(truth, 3000, 3);
  std::vector<double> moved = y;
  constexpr double kUnit = 1e-4;
  for (double& value : moved) value = 9.81 + kUnit * value;
  const ArmaGarchFit a = fit_arma_garch({y}, truth.orders());
  const ArmaGarchFit b = fit_arma_garch({moved}, truth.orders());
  // 9.81 has 1e-15 of rounding, 1e-11 of the signal's unit.
  EXPECT_NEAR(b.model.alpha[0], a.model.alpha[0], 1e-5);
  EXPECT_NEAR(b.model.gamma0 / (kUnit * kUnit), a.model.gamma0, 1e-5 * a.model.gamma0);
  EXPECT_NEAR(b.model.mean(), 9.81 + kUnit * a.model.mean(), 1e-8);
  EXPECT_NEAR(b.log_likelihood, a.log_likelihood - 3000.0 * std::log(kUnit), 1e-6);
}

TEST(ArmaGarchFit, SaysWhereNothingIsKnown) {
  // ARMA(1,1) of white noise: any pair of equal roots fits, and along them the curvature is next to zero.
  const std::vector<double> y = test::simulated_arma_garch({}, 2000, 4);
  const ArmaGarchFit fit = fit_arma_garch({y}, {1, 1, 0, 0});
  EXPECT_LT(fit.nearest_root_pair.value(), 0.2);
  // GARCH of constant variance where chance makes squares avoid each other: gamma ends at zero.
  std::vector<double> alternating = y;
  for (std::size_t t = 0; t < y.size(); t += 2) alternating[t] *= 0.2;
  const ArmaGarchFit garch = fit_arma_garch({alternating}, {0, 0, 1, 0});
  EXPECT_TRUE(garch.converged);
  EXPECT_LT(garch.model.gamma[0], 1e-5);
}

// Whatever a smaller model says, a larger one can say too.
TEST(ArmaGarchOrders, LargerModelsNeverFitWorse) {
  const ArmaGarch truth{.nu = 0.1, .alpha = {0.9}, .beta = {-0.6}, .gamma0 = 0.1, .gamma = {0.1}, .delta = {0.8}};
  const std::vector<double> y = test::simulated_arma_garch(truth, 2500, 6);
  const std::vector<ArmaGarchOrders> grid = arma_garch_grid();
  ASSERT_EQ(grid.size(), 48U);
  const ArmaGarchChoice choice = choose_arma_garch({y}, grid);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_TRUE(choice.fits[i].converged) << i;
    EXPECT_GE(choice.fits[i].aicc(), choice.fits[choice.by_aicc].aicc());
    EXPECT_GE(choice.fits[i].aic(), choice.fits[choice.by_aic].aic());
    for (std::size_t j = 0; j < grid.size(); ++j) {
      const bool is_part = grid[i].ar <= grid[j].ar && grid[i].ma <= grid[j].ma && grid[i].arch <= grid[j].arch &&
                           grid[i].garch <= grid[j].garch;
      // Shares of the variance end at 1e-6: some 1e-4 of log-likelihood short of zero.
      if (is_part) {
        EXPECT_GE(choice.fits[j].log_likelihood, choice.fits[i].log_likelihood - 1e-3) << i << " in " << j;
      }
    }
  }
  const ArmaGarchOrders chosen = choice.fits[choice.by_aicc].model.orders();
  EXPECT_GE(chosen.ar, 1);
  EXPECT_GE(chosen.arch, 1);
}

TEST(ArmaGarchOrders, AreTheSameOnAnyNumberOfThreads) {
  const std::vector<double> y = test::simulated_arma_garch(test::separated_arma_garch(), 1000, 7);
  const std::vector<ArmaGarchOrders> orders{{1, 0, 0, 0}, {1, 1, 1, 1}, {2, 1, 1, 0}, {3, 2, 1, 1}};
  const auto on_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return choose_arma_garch({y}, orders);
  };
  const ArmaGarchChoice one = on_threads(1);
  const ArmaGarchChoice two = on_threads(2);
  EXPECT_EQ(one.by_aicc, two.by_aicc);
  for (std::size_t i = 0; i < orders.size(); ++i)
    EXPECT_EQ(arma_garch_vector(one.fits[i].model, true), arma_garch_vector(two.fits[i].model, true)) << i;
}

}  // namespace
}  // namespace coast::noise
