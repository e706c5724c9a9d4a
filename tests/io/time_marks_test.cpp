#include "coast/io/time_marks.hpp"

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using test::Files;

TEST(TimeMarkTable, InEveryTimeScaleIsTheSameInstant) {
  const Files files;
  const geo::GpsTime t = geo::GpsTime::from_week(2374, 243276.5);  // 2025-07-08 19:34:36.5 in GPS time
  struct Case {
    const char* content;
    const char* keys;
  };
  for (const Case& c : {Case{"time_s,id\n243276.5,a\n", "gps_week: 2374"},
                        {"gps_week,sow_s,id\n2374,243276.5,a\n", ""},
                        {"a;2374;243276.5\n", "columns: {time: [2, 3], id: 1}, time: {kind: week_sow}"},
                        {"id,t\na,2025-07-08T19:34:18.5Z\n", "columns: {time: 2, id: 1}, time: {kind: utc}"},
                        {"id,date,clock\na,2025-07-08,19:34:36.5\n", "columns: {time: [2, 3], id: 1}, time: {kind: gpst}"},
                        {"a,1752003258.5\n", "columns: {time: 2, id: 1}, time: {kind: unix}"},
                        {"a,243276500\n", "columns: {time: 2, id: 1}, time: {unit: ms}, gps_week: 2374"}}) {
    files.put("a.csv", c.content);
    const auto recording = files.events("a.csv", c.keys);
    ASSERT_EQ(recording.marks.size(), 1U) << c.keys;
    EXPECT_EQ(recording.marks[0].t, t) << c.keys << ' ' << geo::to_string(recording.marks[0].t);
    EXPECT_EQ(recording.marks[0].id, "a") << c.keys;
    EXPECT_FALSE(recording.marks[0].r_e) << c.keys;
  }
}

TEST(TimeMarkTable, TheWeekComesFromTheMission) {
  const Files files;
  files.put("a.csv", "time_s\n604799.5\n0.5\n");
  const auto recording = files.events("a.csv", "", geo::GpsTime::from_week(2374, 604700.0));
  ASSERT_EQ(recording.marks.size(), 2U);
  EXPECT_EQ(recording.marks[0].t, geo::GpsTime::from_week(2374, 604799.5));
  EXPECT_EQ(recording.marks[1].t, geo::GpsTime::from_week(2375, 0.5));
  EXPECT_EQ(recording.marks[0].id, "");
}

TEST(TimeMarkTable, IsPutIntoTheOrderOfTimeAndCountsWhatItCannotUse) {
  const Files files;
  files.put("a.csv", "time_s,id,lat_deg,lon_deg,height_m\n12,late,46.5,6.6,400\n11,early,46.4,6.5,410\n13,no fix,,,\n");
  const auto recording = files.events("a.csv", "gps_week: 2374");
  ASSERT_EQ(recording.marks.size(), 2U);
  EXPECT_EQ(recording.marks[0].id, "early");
  EXPECT_EQ(recording.marks[1].id, "late");
  ASSERT_TRUE(recording.marks[0].r_e);
  const Eigen::Vector3d r_e = geo::ecef_from_geodetic({46.4 * geo::kDegree, 6.5 * geo::kDegree, 410.0});
  EXPECT_LT((*recording.marks[0].r_e - r_e).norm(), 1e-8);
  EXPECT_EQ(test::count_of(recording.events, "time_mark_not_finite"), 1);
}

TEST(TimeMarkTable, PositionsInAnotherFrame) {
  const Files files;
  files.put("a.csv", "12 100 200 300\n");
  const auto recording =
      files.events("a.csv", "gps_week: 2374, columns: {time: 1, position: [2, 3, 4]}, frame: ned, origin_deg_m: [46, 7, 0]");
  const geo::LocalFrame local({46.0 * geo::kDegree, 7.0 * geo::kDegree, 0.0});
  ASSERT_TRUE(recording.marks.at(0).r_e);
  EXPECT_LT((*recording.marks[0].r_e - local.to_ecef({100.0, 200.0, 300.0})).norm(), 1e-8);
}

TEST(TimeMarkTable, AMissingWeekOrPositionInARowIsNotMadeUp) {
  const Files files;
  files.put("a.csv", "time_s\n1e12\n");
  EXPECT_NE(test::refusal([&] { (void)files.events("a.csv", "gps_week: 2374"); }).find("a.csv:2: time 1000000000000"),
            std::string::npos);
}

TEST(TimeMarkKeys, AreChecked) {
  const Files files;
  files.put("a.csv", "time_s\n12\n");
  for (const std::string keys : {"edge: up", "columns: {id: 1}", "columns: {time: 1, position: [2, 3]}", "frame: utm",
                                 "gps_week: -1", "time: {kind: gps}"}) {
    const std::string text = test::refusal([&] { (void)files.events("a.csv", keys); });
    EXPECT_NE(text.find("run.yaml:1"), std::string::npos) << keys << " -> " << text;
  }
}

}  // namespace
}  // namespace coast::io
