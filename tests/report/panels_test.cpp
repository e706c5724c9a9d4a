#include "coast/report/panels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "coast/record/gnss.hpp"

namespace coast::report {
namespace {

TEST(Panels, ShadesOnlyTimeAxes) {
  Panel stack = stacked_time_panel("v", "Velocity", {"N", "E", "D"}, "m/s");
  Panel plan = plan_panel("plan", "Plan");
  const std::vector<Interval> outages{{10.0, 20.0, "outage 1", Tone::kBad}};
  shade(stack, outages);
  shade(plan, outages);
  ASSERT_EQ(stack.plots.size(), 3U);
  for (const Plot& plot : stack.plots) EXPECT_EQ(plot.intervals.size(), 1U);
  EXPECT_EQ(stack.plots[1].y.label, "E");
  EXPECT_EQ(stack.plots[1].y.unit, "m/s");
  EXPECT_TRUE(plan.plot().intervals.empty());
  EXPECT_TRUE(plan.plot().equal_aspect);
}

TEST(Panels, CellsOfARowAreLinkedWithEachOtherOnly) {
  Panel grid = grid_panel("g", "Outages", 3);
  for (int i = 0; i < 6; ++i) add_cell(grid, "cell", "time", "N", "m");
  EXPECT_EQ(grid.plots[0].link, grid.plots[2].link);
  EXPECT_NE(grid.plots[2].link, grid.plots[3].link);
}

TEST(Histogram, CountsEveryFiniteValueOnceWhereItBelongs) {
  std::mt19937_64 engine(2);
  std::normal_distribution<double> normal;
  std::vector<double> values(5000);
  for (double& value : values) value = normal(engine);
  values[17] = 1e6;  // an outlier must neither stretch the bins nor be lost
  values[18] = std::nan("");
  Panel panel = xy_panel("h", "NIS", {}, {});
  const Bars bars = add_histogram(panel.plot(), "values", values, 20);
  ASSERT_EQ(bars.heights.size(), 20U);
  ASSERT_EQ(bars.edges.size(), 21U);
  EXPECT_EQ(std::accumulate(bars.heights.begin(), bars.heights.end(), 0.0), 4999.0);
  EXPECT_LT(bars.edges.back(), 5.0);
  for (std::size_t i = 1; i + 1 < bars.heights.size(); ++i) {  // inner bins, by brute force; the edges are half open
    double count = 0.0;
    for (const double value : values) count += value >= bars.edges[i] && value < bars.edges[i + 1] ? 1.0 : 0.0;
    EXPECT_EQ(bars.heights[i], count) << i;
  }
}

TEST(Histogram, TakesEqualValuesAndNone) {
  Panel panel = xy_panel("h", "h", {}, {});
  const Bars equal = add_histogram(panel.plot(), "equal", {3.0, 3.0, 3.0}, 5);
  EXPECT_EQ(std::accumulate(equal.heights.begin(), equal.heights.end(), 0.0), 3.0);
  EXPECT_TRUE(add_histogram(panel.plot(), "none", {}, 5).heights.empty());
  EXPECT_THROW(add_histogram(panel.plot(), "no bins", {1.0}, 0), std::invalid_argument);
}

TEST(Quality, ColoursFollowRtklib) {
  EXPECT_EQ(tone_of(record::FixQuality::kFixed), Tone::kFixed);
  EXPECT_EQ(tone_of(record::FixQuality::kSingle), Tone::kSingle);
  EXPECT_EQ(name_of(record::FixQuality::kFloat), "float");
  EXPECT_EQ(name_of(record::FixQuality::kUnknown), "not stated");
}

}  // namespace
}  // namespace coast::report
