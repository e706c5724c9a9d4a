#include "coast/study/outage.hpp"

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"

namespace coast::study {
namespace {

TEST(OutageSweep, KeepsToAQuarterOfTheMissionAndItsEnd) {
  const geo::GpsTime from = geo::GpsTime::from_week(2374, 1000.0);
  const auto outages = outages_of({.every_s = 30.0, .first_s = 40.0, .durations_s = {10.0, 60.0}}, from, from + 200.0);
  ASSERT_EQ(outages.size(), 5U);  // 40, 70, .. 160; one at 190 would touch the end; 60 s is more than a quarter
  EXPECT_EQ(outages.front().start, from + 40.0);
  EXPECT_EQ(outages.back().start, from + 160.0);
}

// A straight line against a reference that it leaves by s^2 / 2 m north and -s m down from the outage's start on.
TEST(OutageRecorder, SummarisesAKnownDrift) {
  const geo::Geodetic p{0.7, 0.2, 100.0};
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  const geo::GpsTime start = geo::GpsTime::from_week(2374, 1000.0);
  record::ImuRecording imu;
  record::GnssRecording gnss;
  for (int k = -20; k <= 40; ++k) {
    record::GnssFix fix;
    fix.t = start + static_cast<double>(k);
    fix.r_ea_e = geo::ecef_from_geodetic(p);
    fix.position_cov_n = 1e-4 * Eigen::Matrix3d::Identity();
    gnss.fixes.push_back(fix);
  }
  const estimate::Mission mission{imu, gnss};
  record::Trajectory reference;
  for (int k = -200; k <= 400; ++k) {
    record::NavState nav;
    nav.t = start + 0.1 * k;
    nav.r_eb_e = geo::ecef_from_geodetic(p);
    nav.q_b_e = Eigen::Quaterniond(C_n_e);
    reference.states.push_back(nav);
  }
  OutageRecorder recorder({start, 10.0}, reference, Eigen::Vector3d::Zero(), mission);
  for (int k = -100; k <= 300; ++k) {
    const double s = std::max(0.0, 0.05 * k);
    record::TrajectoryEpoch epoch;
    epoch.nav.t = start + 0.05 * k;
    epoch.nav.r_eb_e = geo::ecef_from_geodetic(p) + C_n_e * Eigen::Vector3d(0.5 * s * s, 0.0, -s);
    epoch.nav.v_eb_e = C_n_e * Eigen::Vector3d(s, 0.0, s > 0.0 ? -1.0 : 0.0);
    epoch.nav.q_b_e = Eigen::Quaterniond(C_n_e);
    epoch.cov.position = Eigen::Vector3d(900.0, 1.0, 4.0).asDiagonal();
    recorder.add(epoch);
  }
  const OutageErrors e = recorder.errors();
  // The last epoch before the fix at 10 s is 9.95 s.
  EXPECT_NEAR(e.end_m.x(), 0.5 * 9.95 * 9.95, 1e-6);
  EXPECT_NEAR(e.end_m.z(), -9.95, 1e-6);
  EXPECT_NEAR(e.max_m.x(), 0.5 * 9.95 * 9.95, 1e-6);
  EXPECT_NEAR(e.horizontal_max_m, 0.5 * 9.95 * 9.95, 1e-6);
  EXPECT_NEAR(e.sigma_end_m.x(), 30.0, 1e-9);
  double square = 0.0;
  for (int k = 0; k < 100; ++k) square += std::pow(0.5 * 0.01 * k * k, 2);
  EXPECT_NEAR(e.rms_m.x(), std::sqrt(square / 100.0), 1e-6);
  // North and east are inside 1.96 sigma throughout; down leaves 3.92 m after 3.92 s, so 40 of 100 epochs are inside.
  EXPECT_EQ(e.tested, 300U);
  EXPECT_EQ(e.inside_95, 240U);
  ASSERT_TRUE(e.gnss_horizontal_max_m.has_value());
  // The last withheld fix is at 9 s; the horizon 40 m away is tilted by 6e-6 rad, which turns 9 m of height into 6e-5 m.
  EXPECT_NEAR(*e.gnss_horizontal_max_m, 0.5 * 9.0 * 9.0, 1e-4);
}

}  // namespace
}  // namespace coast::study
