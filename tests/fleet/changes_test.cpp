// Changes of drawn fleets: what was put in is found, dated and sized; what was not, is not.

#include "coast/fleet/changes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "coast/fleet/student.hpp"
#include "fleet/drawn.hpp"
#include "panel_test.hpp"

namespace coast::fleet {
namespace {

ChangeOptions quick() {
  ChangeOptions options;
  options.simulations = 199;
  return options;
}

TEST(PanelTest, StatisticIsLeastSquaresWhereNothingIsClipped) {
  // Residuals of nearly one size are clipped nowhere: the statistic is the drop of the sum of squares over the variance.
  Panel panel{"bias", "", "m", {{"u", {}}}};
  for (int i = 0; i < 10; ++i) {
    Estimate e;
    e.mission = fmt::format("{}", i);
    e.t = 0.2 * i;
    e.sigma = 1.0;
    e.value = (i % 2 == 0 ? 1.0 : -1.0) + (i >= 6 ? 0.3 : 0.0);
    panel.series[0].estimates.push_back(e);
  }
  const PanelTest test(panel, {}, {}, {});
  const Candidate best = test.strongest(test.values()).own;
  const Eigen::VectorXd y = test.values()[0];
  const auto sum_of_squares = [&](const Eigen::MatrixXd& X) {
    return (y - X * X.colPivHouseholderQr().solve(y)).squaredNorm();
  };
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(10);
  const double variance = sum_of_squares(one) / 9.0 / 0.778465;  // E min(x^2, 1.5^2), by numerical integration in R
  double largest = 0.0;
  for (int k = 2; k <= 7; ++k) {  // 2 stands for the drift
    Eigen::MatrixXd X(10, 2);
    X.col(0) = one;
    for (int i = 0; i < 10; ++i) X(i, 1) = k == 2 ? 0.2 * i : i >= k ? 1.0 : 0.0;
    largest = std::max(largest, (sum_of_squares(one) - sum_of_squares(X)) / variance);
  }
  EXPECT_NEAR(best.statistic / largest, 1.0, 3e-3);  // the scale is iterated to 1e-3
}

TEST(Changes, AreFoundDatedAndSized) {
  Fleet all = test::drawn_fleet(21);
  const auto add = [&](std::size_t panel, std::size_t unit, const auto& what) {
    for (Estimate& e : all.panels[panel].series[unit].estimates) e.value += what(e);
  };
  const double moved_at = 0.5 * (all.panels[0].series[3].estimates[6].t + all.panels[0].series[3].estimates[7].t);
  add(0, 3, [&](const Estimate& e) { return e.t > moved_at ? -12.0 : 0.0; });
  add(1, 3, [&](const Estimate& e) { return e.t > moved_at ? 4.0 : 0.0; });  // too little by itself
  add(1, 7, [](const Estimate& e) { return 9.0 * e.t; });
  for (const std::size_t u : {0U, 2U, 5U, 8U}) add(2, u, [](const Estimate& e) { return e.t > 1.1 ? 11.0 : 0.0; });
  all.panels[0].series[9].estimates[4].value += 25.0;
  const FleetChanges found = find_changes(all, quick());
  const std::vector<Change>& x = found.panels[0].changes;
  ASSERT_EQ(x.size(), 1U);
  EXPECT_EQ(x[0].kind, ChangeKind::kStep);
  EXPECT_EQ(x[0].units, std::vector<std::size_t>{3});
  EXPECT_LE(x[0].t_95.first, moved_at);
  EXPECT_GE(x[0].t_95.second, moved_at);
  EXPECT_NEAR(x[0].common_size, -12.0, 4.0 * x[0].common_sd);
  EXPECT_LT(x[0].common_sd, 2.0);
  const std::vector<Change>& y = found.panels[1].changes;
  ASSERT_GE(y.size(), 1U);
  const auto drift = std::ranges::find(y, ChangeKind::kDrift, &Change::kind);
  ASSERT_NE(drift, y.end());
  EXPECT_EQ(drift->units, std::vector<std::size_t>{7});
  EXPECT_NEAR(drift->common_size, 9.0, 4.0 * drift->common_sd);
  const std::vector<Change>& z = found.panels[2].changes;
  ASSERT_EQ(z.size(), 1U);
  EXPECT_EQ(z[0].units, (std::vector<std::size_t>{0, 2, 5, 8}));
  EXPECT_NEAR(z[0].t, 1.1, 0.1);
  EXPECT_NEAR(z[0].common_size, 11.0, 4.0 * z[0].common_sd);
  ASSERT_TRUE(found.departures.front().outlier);
  EXPECT_EQ(found.departures.front().panel, 0U);
  EXPECT_EQ(found.departures.front().series, 9U);
  EXPECT_EQ(found.departures.front().index, 4U);
  EXPECT_FALSE(found.departures[1].outlier);
}

TEST(Departures, DoNotHideOneAnother) {
  Fleet all = test::drawn_fleet(31);
  // Thirteen sigmas of a mission with its scatter: each is what the tails would be judged by if the other counted in full.
  const std::vector<std::pair<std::size_t, std::size_t>> added{{2, 5}, {7, 9}, {10, 4}};
  for (const auto& [unit, mission] : added) {
    Estimate& e = all.panels[1].series[unit].estimates[mission];
    e.value += 13.0 * std::hypot(2.0, e.sigma);
  }
  const FleetChanges found = find_changes(all, quick());
  for (const PanelChanges& panel : found.panels) EXPECT_TRUE(panel.changes.empty());
  for (std::size_t i = 0; i < 3; ++i) {
    const Departure& d = found.departures[i];
    EXPECT_TRUE(d.outlier);
    EXPECT_EQ(d.panel, 1U);
    EXPECT_TRUE(std::ranges::find(added, std::pair{d.series, d.index}) != added.end());
  }
  EXPECT_FALSE(found.departures[3].outlier);
}

TEST(Changes, LevelsOfAGroupAreTold) {
  Fleet all = test::drawn_fleet(22);
  all.factors = {"firmware"};
  for (Panel& panel : all.panels)
    for (Series& series : panel.series)
      for (std::size_t m = 0; m < series.estimates.size(); ++m) {
        series.estimates[m].groups = {m % 3 == 1 ? "2.1" : "2.0"};
        if (m % 3 == 1 && &panel == &all.panels[1]) series.estimates[m].value += 3.0;
      }
  const FleetChanges found = find_changes(all, quick());
  ASSERT_EQ(found.panels[1].changes.size(), 1U);
  const Change& change = found.panels[1].changes[0];
  EXPECT_EQ(change.kind, ChangeKind::kGroupLevel);
  EXPECT_EQ(change.level, "2.1");
  EXPECT_NEAR(change.common_size, 3.0, 4.0 * change.common_sd);
  EXPECT_TRUE(found.panels[0].changes.empty());
}

TEST(Changes, AWalkOfAllUnitsIsNoHostOfSteps) {
  Fleet all = test::drawn_fleet(23);
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (Series& series : all.panels[1].series) {
    double walk = 0.0;
    for (std::size_t m = 1; m < series.estimates.size(); ++m) {
      walk += 15.0 * std::sqrt(series.estimates[m].t - series.estimates[m - 1].t) * normal(random);
      series.estimates[m].value += walk;
    }
  }
  const FleetChanges found = find_changes(all, quick());
  EXPECT_TRUE(found.panels[1].changes.empty());
  EXPECT_NEAR(found.panels[1].scatter.walk, 15.0, 5.0);
  EXPECT_EQ(found.panels[0].scatter.walk, 0.0);
}

TEST(Changes, FalseAlarmsAreAsStated) {
  // 120 small fleets at 20 %: the share's sigma is 3.7 %; less than 20 % + 3 sigma. reference_runs/fleet has larger numbers.
  int alarms = 0;
  constexpr int kFleets = 120;
  ChangeOptions options;
  options.false_alarm_probability = 0.2;
  options.simulations = 99;
  for (int i = 0; i < kFleets; ++i) {
    const FleetChanges found = find_changes(test::drawn_fleet(1000U + static_cast<unsigned>(i), 6, 10), options);
    const bool changed = std::ranges::any_of(found.panels, [](const PanelChanges& p) { return !p.changes.empty(); });
    alarms += changed || found.departures.front().outlier ? 1 : 0;
  }
  EXPECT_LE(alarms, (0.2 + 3.0 * 0.037) * kFleets);
  EXPECT_GE(alarms, 3);  // a threshold that nothing reaches would be no test: half of the stated share at least is used
}

TEST(Changes, SameFleetSameNumbers) {
  const Fleet all = test::drawn_fleet(24);
  const FleetChanges a = find_changes(all, quick());
  const FleetChanges b = find_changes(all, quick());
  EXPECT_EQ(a.threshold, b.threshold);
  EXPECT_EQ(a.departures.front().p, b.departures.front().p);
}

}  // namespace
}  // namespace coast::fleet
