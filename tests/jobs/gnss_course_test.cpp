// Which fix an epoch of the solution rests on.

#include "process/gnss_course.hpp"

#include <gtest/gtest.h>

namespace coast::jobs {
namespace {

const geo::GpsTime kBegin = geo::GpsTime::from_week(2374, 1000.0);

/// A fix each second, with as many satellites as its second says.
record::GnssRecording ten_fixes() {
  record::GnssRecording gnss;
  for (int i = 0; i < 10; ++i) {
    record::GnssFix fix;
    fix.t = kBegin + i;
    fix.r_ea_e.setZero();
    fix.position_cov_n.setIdentity();
    fix.quality = i < 5 ? record::FixQuality::kFixed : record::FixQuality::kFloat;
    fix.satellites = i;
    gnss.fixes.push_back(fix);
  }
  return gnss;
}

TEST(GnssCourse, IsTheNearestFixThatWasUsedOrNone) {
  const record::ImuRecording imu;
  const record::GnssRecording gnss = ten_fixes();
  const estimate::Mission mission{.imu = imu, .gnss = gnss, .time_offset_s = 0.25};  // fixes are valid at 999.75 and so on
  GnssCourse course(mission);
  EXPECT_FALSE(course.at(kBegin).has_value());
  for (std::size_t i = 0; i < 10; ++i) {
    course.add({estimate::UpdateKind::kGnssPosition, i}, i != 4 && i != 5 && i != 6);
    course.add({estimate::UpdateKind::kGnssVelocity, i}, true);
  }
  EXPECT_EQ(course.at(kBegin + 1.2)->satellites, 1);
  EXPECT_EQ(course.at(kBegin + 1.3)->satellites, 2);
  EXPECT_EQ(course.at(kBegin + 4.2)->quality, record::FixQuality::kFixed);
  EXPECT_FALSE(course.at(kBegin + 4.3).has_value());  // more than a step and a half behind the fix of 2.75
  EXPECT_FALSE(course.at(kBegin + 5.2).has_value());
  EXPECT_EQ(course.at(kBegin + 5.3)->quality, record::FixQuality::kFloat);
  EXPECT_EQ(course.at(kBegin + 10.2)->satellites, 9);
  EXPECT_FALSE(course.at(kBegin + 10.3).has_value());
}

TEST(GnssCourse, OfTightCouplingHasTheFixesThatAreNotWithheld) {
  const record::ImuRecording imu;
  const record::GnssRecording gnss = ten_fixes();
  const estimate::Mission mission{.imu = imu, .gnss = gnss};
  GnssCourse course(mission);
  course.add_all_but({{kBegin + 2.5, kBegin + 7.5, 0}, {kBegin + 7.6, kBegin + 8.5, 3}});
  EXPECT_TRUE(course.at(kBegin + 3.4).has_value());
  EXPECT_FALSE(course.at(kBegin + 5.0).has_value());
  EXPECT_EQ(course.at(kBegin + 8.0)->satellites, 8);  // some satellites were left
}

}  // namespace
}  // namespace coast::jobs
