#include "coast/study/study_result.hpp"

#include <gtest/gtest.h>

namespace coast::study {
namespace {

TEST(StudyGroups, AreTheOutagesOfASweepByDuration) {
  const OutageSweep sweep{.every_s = 30.0, .first_s = 40.0, .durations_s = {10.0, 60.0, 50.0, 0.5}};
  const std::vector<OutageGroup> groups = grouped(sweep, 200.0);
  ASSERT_EQ(groups.size(), 3U);  // 60 s are more than a quarter
  EXPECT_EQ(groups[0].duration_s, 10.0);
  EXPECT_EQ(groups[0].starts_s, (std::vector{40.0, 70.0, 100.0, 130.0, 160.0}));  // one at 190 s would touch the end
  EXPECT_EQ(groups[1].duration_s, 50.0);
  EXPECT_EQ(groups[1].starts_s, (std::vector{40.0, 70.0, 100.0, 130.0}));
  EXPECT_EQ(groups[2].duration_s, 0.5);
  EXPECT_EQ(groups[2].starts_s, (std::vector{40.0, 70.0, 100.0, 130.0, 160.0, 190.0}));
  EXPECT_TRUE(grouped(sweep, 1.0).empty());
}

/// One error model with these errors, horizontal and down.
ModelRun run_with(const std::vector<double>& forward, const std::vector<double>& smoothed) {
  ModelRun run;
  run.outages.emplace_back();
  for (std::size_t i = 0; i < forward.size(); ++i) {
    OutageResult outage;
    outage.forward.horizontal_max_m = forward[i];
    outage.smoothed = OutageErrors{};
    outage.smoothed->horizontal_max_m = smoothed[i];
    outage.forward.max_m.z() = 7.0 * smoothed[i];
    run.outages.front().push_back(outage);
  }
  return run;
}

// Two places that share half their time, three recordings that share nothing.
TEST(StudyComparison, CountsOverlapWithinARecordingOnly) {
  StudyResult study;
  study.groups = {{20.0, {100.0, 110.0}}};
  study.seeds = 3;
  const std::vector<double> a{1.0, 2.0, 3.0, 1.5, 2.5, 0.5};
  const std::vector<double> b{1.1, 1.9, 2.0, 1.4, 2.7, 0.4};
  study.runs = {run_with(a, b), run_with(b, a)};
  const std::vector<double> times{100.0, 10100.0, 20100.0, 110.0, 10110.0, 20110.0};  // start by start, in it seed by seed
  const auto expect_same = [](const PairedRatio& found, const PairedRatio& expected) {
    EXPECT_NEAR(found.ratio, expected.ratio, 1e-12);
    EXPECT_NEAR(found.low, expected.low, 1e-12);
    EXPECT_NEAR(found.high, expected.high, 1e-12);
    EXPECT_EQ(found.second_smaller, expected.second_smaller);
  };
  const auto compared = [&](DriftMeasure measure, bool smoothed) {
    return compare(study, study.runs[0], study.runs[1], 0, measure, smoothed);
  };
  expect_same(compared(DriftMeasure::kHorizontal, false), paired_ratio(a, b, times, 20.0));
  expect_same(compared(DriftMeasure::kHorizontal, true), paired_ratio(b, a, times, 20.0));
  expect_same(compared(DriftMeasure::kDown, false), paired_ratio(b, a, times, 20.0));
  EXPECT_GT(compared(DriftMeasure::kHorizontal, false).high, paired_ratio(a, b).high);
}

}  // namespace
}  // namespace coast::study
