// Random effects against closed forms, R, brute force and coverage.

#include "coast/fleet/random_effects.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "coast/fleet/pool.hpp"
#include "coast/fleet/student.hpp"
#include "coast/study/paired.hpp"
#include "fleet/drawn.hpp"

namespace coast::fleet {
namespace {

Observations mean_of(const Eigen::VectorXd& y, const Eigen::VectorXd& sigma) {
  return {y, sigma, Eigen::VectorXd::LinSpaced(y.size(), 0.0, 1.0), Eigen::MatrixXd::Ones(y.size(), 1)};
}

TEST(RandomEffects, BalancedCaseHasAClosedForm) {
  Eigen::VectorXd y(6);
  y << 1.0, 4.0, 2.0, 7.0, 3.0, 4.5;
  const double s2 = (y.array() - y.mean()).square().sum() / 5.0;
  const RandomEffects fit = random_effects(mean_of(y, Eigen::VectorXd::Constant(6, 0.7)));
  EXPECT_NEAR(fit.beta[0], y.mean(), 1e-12);
  EXPECT_NEAR(fit.scatter.tau, std::sqrt(s2 - 0.49), 1e-6);  // golden section: square root of the rounding of a likelihood
  EXPECT_NEAR(fit.sd(0), std::sqrt(s2 / 6.0), 1e-6);
  const auto [low, high] = fit.interval_95(0);
  EXPECT_NEAR(high - low, 2.0 * study::student_t_quantile(0.975, 5) * std::sqrt(s2 / 6.0), 1e-5);
  // Sigmas that explain more than all: no scatter, and Hartung and Knapp's factor still from the residuals.
  const RandomEffects none = random_effects(mean_of(y, Eigen::VectorXd::Constant(6, 9.0)));
  EXPECT_EQ(none.scatter.tau, 0.0);
  EXPECT_EQ(none.tau_95.first, 0.0);
  EXPECT_NEAR(none.sd(0), std::sqrt(s2 / 6.0), 1e-12);
}

TEST(RandomEffects, AgreesWithRsOptimizer) {
  // R: ll <- function(tau) { V <- diag(s^2+tau^2); W <- solve(V); A <- t(X)%*%W%*%X; b <- solve(A, t(X)%*%W%*%y); r <- y-X%*%b;
  //    -0.5*(log(det(V))+log(det(A))+t(r)%*%W%*%r) };  optimize(ll, c(0,0.1), maximum=TRUE, tol=1e-12);  uniroot of the profile
  Observations o = mean_of(Eigen::VectorXd(8), Eigen::VectorXd(8));
  o.y << 0.412, 0.380, 0.451, 0.405, 0.397, 0.442, 0.449, 0.371;
  o.sigma << 0.004, 0.010, 0.006, 0.012, 0.008, 0.015, 0.005, 0.009;
  o.X = Eigen::MatrixXd::Ones(8, 2);
  o.X.col(1) << 2.0, -7.0, 15.0, 8.0, -12.0, 20.0, -1.0, -3.0;
  const RandomEffects fit = random_effects(o);
  EXPECT_NEAR(fit.scatter.tau, 0.02419576, 2e-8);  // printed digits
  EXPECT_NEAR(restricted_log_likelihood(o, fit.scatter), 14.6426191124, 1e-9);
  EXPECT_NEAR(fit.tau_95.second, 0.05028239, 2e-8);
  EXPECT_GT(fit.tau_95.first, 0.0);
  EXPECT_NEAR(fit.beta[0], 0.409105308, 2e-9);
  EXPECT_NEAR(fit.beta[1], 0.001918909, 2e-9);
  EXPECT_NEAR(fit.sd(0), 0.009225463, 5e-9);
  EXPECT_NEAR(fit.sd(1), 0.000901423, 2e-9);
}

TEST(RandomEffects, RestrictedLikelihoodIsThatOfContrasts) {
  // Dense normal density of contrasts K'y with K'X = 0, K'K = I; they differ by log|X'X| / 2 and the constant of 2 pi alone.
  Observations o = mean_of(Eigen::VectorXd(6), Eigen::VectorXd(6));
  o.y << 1.0, 4.0, 2.0, 7.0, 3.0, 4.5;
  o.sigma << 0.4, 1.0, 0.6, 1.2, 0.8, 0.5;
  o.t << 0.0, 0.1, 0.5, 0.6, 1.1, 1.9;
  o.X = Eigen::MatrixXd::Ones(6, 2);
  o.X.col(1) = o.t;
  const Eigen::MatrixXd Q = o.X.householderQr().householderQ();
  const Eigen::MatrixXd K = Q.rightCols(4);
  for (const Scatter& scatter : {Scatter{0.0, 0.0}, Scatter{1.3, 0.0}, Scatter{0.5, 2.0}}) {
    Eigen::MatrixXd V = (o.sigma.array().square() + scatter.tau * scatter.tau).matrix().asDiagonal();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) V(i, j) += scatter.walk * scatter.walk * std::min(o.t[i], o.t[j]);
    const Eigen::MatrixXd S = K.transpose() * V * K;
    const Eigen::VectorXd k = K.transpose() * o.y;
    const double dense = -0.5 * (std::log(S.determinant()) + k.dot(S.inverse() * k));
    const double offset = -0.5 * std::log((o.X.transpose() * o.X).determinant());
    EXPECT_NEAR(restricted_log_likelihood(o, scatter), dense + offset, 1e-10);
  }
}

TEST(RandomEffects, IntervalsHoldWhatTheyPromise) {
  // 2000 draws: one sigma of a share of 95 % is 0.5 %; four sigma.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd sigma(8);
  sigma << 0.4, 1.0, 0.6, 1.2, 0.8, 0.5, 2.0, 0.7;
  int mean_inside = 0;
  int tau_inside = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    Eigen::VectorXd y(8);
    for (int m = 0; m < 8; ++m) y[m] = 3.0 + 1.0 * normal(random) + sigma[m] * normal(random);
    const RandomEffects fit = random_effects(mean_of(y, sigma));
    const auto [low, high] = fit.interval_95(0);
    mean_inside += low <= 3.0 && 3.0 <= high ? 1 : 0;
    tau_inside += fit.tau_95.first <= 1.0 && 1.0 <= fit.tau_95.second ? 1 : 0;
  }
  EXPECT_NEAR(mean_inside, 0.95 * kDraws, 0.02 * kDraws);
  EXPECT_NEAR(tau_inside, 0.95 * kDraws, 0.03 * kDraws);  // chi-square is the profile's limit for many missions
}

TEST(RandomEffects, FindsARandomWalk) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<Observations> units;
  for (int u = 0; u < 20; ++u) {
    Observations o = mean_of(Eigen::VectorXd(20), Eigen::VectorXd::Constant(20, 0.3));
    o.t = Eigen::VectorXd::LinSpaced(20, 0.0, 2.0);
    double walk = 5.0;
    for (int m = 0; m < 20; ++m) {
      if (m > 0) walk += 3.0 * std::sqrt(o.t[m] - o.t[m - 1]) * normal(random);
      o.y[m] = walk + 0.5 * normal(random) + 0.3 * normal(random);
    }
    units.push_back(o);
  }
  const Scatter found = panel_scatter(units, true);
  EXPECT_NEAR(found.walk, 3.0, 0.6);  // 380 increments: 5 % of the size, four sigma with the scatter's share
  EXPECT_NEAR(found.tau, 0.5, 0.25);
}

TEST(Student, AgreesWithRAndIntegerDegrees) {
  // R: 2*pt(-3,4.5), 2*pt(-12,5), 2*pt(-0.3,2.5), printed to 12 digits
  EXPECT_NEAR(student_two_sided(3.0, 4.5) / 0.0343808678888, 1.0, 1e-11);
  EXPECT_NEAR(student_two_sided(-12.0, 5.0) / 7.08949251716e-05, 1.0, 1e-11);
  EXPECT_NEAR(student_two_sided(0.3, 2.5) / 0.787342371495, 1.0, 1e-11);
  for (const int dof : {1, 4, 30})
    EXPECT_NEAR(student_two_sided_quantile(0.05, dof), study::student_t_quantile(0.975, dof), 1e-8);
  EXPECT_NEAR(student_two_sided_quantile(0.05, HUGE_VAL), 1.959963984540054, 1e-12);
}

TEST(Student, TellsTheTailsOfASample) {
  std::mt19937_64 random(7);
  std::student_t_distribution<double> heavy(5.0);
  std::normal_distribution<double> normal;
  std::vector<double> a(5000);
  std::vector<double> b(5000);
  for (double& v : a) v = 2.0 * heavy(random);
  for (double& v : b) v = normal(random);
  EXPECT_NEAR(heaviest_tails(a).nu, 4.5, 0.8);  // the lower end: sd of nu is about 0.4 for 5000 values
  EXPECT_NEAR(heaviest_tails(a).scale, 2.0, 0.15);
  EXPECT_GT(heaviest_tails(b).nu, 30.0);
}

TEST(Student, WhatIsLargerCountsAsSuch) {
  // R: v <- 1.5*qt((1:40-0.5)/40, 4); o <- v[order(abs(v))][1:39]
  //    f <- function(ls) sum(dt(o/exp(ls), 1/inv, log=TRUE)) - 39*ls + log(2*pt(-max(abs(o))/exp(ls), 1/inv))
  //    optimize(f, c(-3,3), maximum=TRUE) for inv in 0.4*(0:40)/40
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) {
    const double v = 1.5 * student_two_sided_quantile((2.0 * i + 1.0) / 40.0, 4.0);
    values.insert(values.end(), {-v, v});
  }
  values.erase(values.begin());  // of the two largest
  EXPECT_NEAR(likeliest_tails(values, 1).nu, 1.0 / 0.27, 1e-9);
  EXPECT_NEAR(likeliest_tails(values, 1).scale, 1.482767, 2e-5);
  EXPECT_NEAR(heaviest_tails(values, 1).nu, 2.5, 1e-9);
  EXPECT_NEAR(heaviest_tails(values, 1).scale, 1.355692, 2e-5);
}

TEST(Pool, TemperatureIsNotAgeingAndUnitsLendStrength) {
  Fleet all = test::drawn_fleet(4);
  Panel& panel = all.panels[0];
  for (Estimate& e : panel.series[2].estimates) e.value += 0.8 * *e.temperature;
  for (Estimate& e : panel.series[5].estimates) e.value += 6.0 * e.t;
  PanelChanges model;
  model.scatter.tau = 2.0;
  std::vector<std::vector<bool>> none(panel.series.size(), std::vector<bool>(15, false));
  const PooledPanel pooled = pool(panel, model, none);
  ASSERT_TRUE(pooled.units[2].temperature && pooled.units[5].drift);
  EXPECT_NEAR(pooled.units[2].temperature->value, 0.8, 4.0 * pooled.units[2].temperature->sd);
  EXPECT_TRUE(pooled.units[2].temperature->supported);
  EXPECT_FALSE(pooled.units[2].drift->supported);
  EXPECT_NEAR(pooled.units[5].drift->value, 6.0, 4.0 * pooled.units[5].drift->sd);
  EXPECT_TRUE(pooled.units[5].drift->supported);
  EXPECT_FALSE(pooled.units[5].temperature->supported);
  ASSERT_TRUE(pooled.mean);
  EXPECT_NEAR(pooled.mean->between, 20.0, 4.0 * 20.0 / std::sqrt(22.0));  // sd of a standard deviation of 12 values
  for (const PooledUnit& unit : pooled.units) {
    EXPECT_LT(unit.shrunk_sd, unit.sd);
    EXPECT_LE(std::abs(unit.shrunk - pooled.mean->value), std::abs(unit.value - pooled.mean->value));
  }
}

}  // namespace
}  // namespace coast::fleet
