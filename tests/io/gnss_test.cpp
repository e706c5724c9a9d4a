#include "coast/io/gnss.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/writers.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using geo::GpsTime;
using record::FixQuality;
using test::count_of;
using test::Files;
using test::refusal;

constexpr const char* kLlhHeader =
    "% program   : RTKLIB ver.2.4.3\n% ref pos   : 35.132063800  139.624289600   74.8473\n%\n"
    "% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp,ns=# of satellites)\n"
    "%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  "
    "sdun(m) age(s)  ratio\n";

geo::Geodetic degrees(double latitude, double longitude, double height) {
  return {latitude * geo::kDegree, longitude * geo::kDegree, height};
}

void expect_position(const record::GnssFix& fix, const geo::Geodetic& p, double tolerance) {
  EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic(p)).norm(), tolerance);
}

TEST(RtklibPos, DegreesWithSignedRootCovariance) {
  const Files files;
  files.put("a.pos", std::string(kLlhHeader) +
                         "2009/04/07 00:00:30.500   35.160869420  139.613901850   66.1523   2   7   0.0120   0.0080   0.0300"
                         "  -0.0050   0.0060   0.0100   1.00    2.5\n");
  const auto gnss = files.gnss("a.pos");
  ASSERT_EQ(gnss.fixes.size(), 1U);
  const auto& fix = gnss.fixes[0];
  EXPECT_EQ(fix.t, GpsTime::from_calendar({2009, 4, 7, 0, 0, 30.5}));
  expect_position(fix, degrees(35.160869420, 139.613901850, 66.1523), 1e-6);
  EXPECT_EQ(fix.quality, FixQuality::kFloat);
  EXPECT_EQ(fix.satellites, 7);
  EXPECT_EQ(fix.age_s, 1.0);
  EXPECT_EQ(fix.ratio, 2.5);
  EXPECT_FALSE(fix.velocity);
  // cov(n,e) = -0.005^2; cov(e,u) = 0.006^2 and cov(u,n) = 0.01^2 change sign with down.
  Eigen::Matrix3d expected;
  expected << 1.44e-4, -2.5e-5, -1e-4, -2.5e-5, 6.4e-5, -3.6e-5, -1e-4, -3.6e-5, 9e-4;
  test::expect_near_matrix(fix.position_cov_n, expected, 1e-12, "covariance");
}

TEST(RtklibPos, WeekAndSecondsCommasUtcAndJst) {
  const GpsTime t = GpsTime::from_calendar({2009, 4, 7, 0, 0, 30.0});
  const std::string rest = " 35.1 139.6 66.0 1 7 0.01 0.01 0.02 0 0 0 0 0\n";
  std::string commas = rest;
  std::replace(commas.begin() + 1, commas.end(), ' ', ',');
  const std::string names =
      "latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) sdun(m) age(s) ratio\n";
  const Files files;
  // 15 leap seconds in April 2009; Japan is nine hours ahead of UTC.
  for (const std::string& text :
       {"%  GPST " + names + fmt::format("{} {:.3f}", t.week(), t.sow()) + rest,
        "%  GPST " + names + fmt::format("{},{:.3f},", t.week(), t.sow()) + commas.substr(1),
        "%  GPST " + names + "2009/04/07 00:00:30.000," + commas.substr(1),
        "%  UTC " + names + "2009/04/07 00:00:15.000" + rest, "%  JST " + names + "2009/04/07 09:00:15.000" + rest}) {
    files.put("a.pos", text);
    const auto gnss = files.gnss("a.pos");
    ASSERT_EQ(gnss.fixes.size(), 1U);
    EXPECT_EQ(gnss.fixes[0].t, t) << text;
    EXPECT_FALSE(gnss.fixes[0].age_s);
    EXPECT_FALSE(gnss.fixes[0].ratio);
    expect_position(gnss.fixes[0], degrees(35.1, 139.6, 66.0), 1e-6);
  }
}

TEST(RtklibPos, DegreesMinutesSecondsKeepTheSignOfMinusZero) {
  const Files files;
  files.put("a.pos",
            "%  GPST latitude(d'\") longitude(d'\") height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) sdun(m) age(s) ratio\n"
            "2009/04/07 00:00:30.000  -0 09 39.12993 -139 36 50.04000   66.1523   1   7   0.01 0.01 0.02 0 0 0 0.0 99.9\n");
  const auto gnss = files.gnss("a.pos");
  expect_position(gnss.fixes[0], degrees(-(9.0 + 39.12993 / 60.0) / 60.0, -(139.0 + (36.0 + 50.04 / 60.0) / 60.0), 66.1523),
                  1e-6);
}

TEST(RtklibPos, EcefWithVelocityRotatesItsCovariance) {
  const geo::Geodetic p = degrees(40.0, -105.0, 1600.0);
  const Eigen::Vector3d r = geo::ecef_from_geodetic(p);
  const Eigen::Matrix3d C = geo::C_n_e(p);
  const Eigen::Vector3d v_n(3.0, -4.0, 0.5);
  const Eigen::Vector3d v_e = C * v_n;
  const Files files;
  files.put(
      "a.pos",
      fmt::format(
          "%  GPST x-ecef(m) y-ecef(m) z-ecef(m) Q ns sdx(m) sdy(m) sdz(m) sdxy(m) sdyz(m) sdzx(m) age(s) ratio vx(m/s) "
          "vy(m/s) vz(m/s) sdvx sdvy sdvz sdvxy sdvyz sdvzx\n"
          "2374 243258.5 {:.6f} {:.6f} {:.6f} 1 20 0.02 0.03 0.04 0.01 -0.02 0.015 0 0 {:.9f} {:.9f} {:.9f} 0.1 0.2 0.3 0 "
          "0 0\n",
          r.x(), r.y(), r.z(), v_e.x(), v_e.y(), v_e.z()));
  const auto fix = files.gnss("a.pos").fixes.at(0);
  EXPECT_LT((fix.r_ea_e - r).norm(), 2e-6);
  Eigen::Matrix3d cov_e;
  cov_e << 4e-4, 1e-4, 2.25e-4, 1e-4, 9e-4, -4e-4, 2.25e-4, -4e-4, 1.6e-3;
  test::expect_near_matrix(fix.position_cov_n, C.transpose() * cov_e * C, 1e-9, "covariance");
  ASSERT_TRUE(fix.velocity);
  test::expect_near_matrix(fix.velocity->v_ea_n, v_n, 1e-8, "velocity");
  const Eigen::Vector3d sd(0.1, 0.2, 0.3);
  test::expect_near_matrix(fix.velocity->cov_n, C.transpose() * sd.cwiseAbs2().asDiagonal() * C, 1e-9, "velocity covariance");
}

TEST(RtklibPos, BaselineEastNorthUpFromItsReferencePosition) {
  const geo::Geodetic base = degrees(35.0, 139.0, 50.0);
  const Files files;
  const std::string names =
      "%  GPST e-baseline(m) n-baseline(m) u-baseline(m) Q ns sde(m) sdn(m) sdu(m) sden(m) sdnu(m) sdue(m) age(s) ratio\n";
  const std::string row = "2374 100.0 30.0 40.0 -2.0 1 20 0.01 0.02 0.03 0.005 0 0 0 0\n";
  files.put("a.pos", "% ref pos   : 35.000000000  139.000000000   50.0000\n" + names + row);
  const auto fix = files.gnss("a.pos").fixes.at(0);
  EXPECT_LT((fix.r_ea_e - geo::LocalFrame(base).to_ecef({40.0, 30.0, 2.0})).norm(), 1e-6);
  // 50 m from the base the axes differ by 1e-5 rad: N and E change places, nothing else to 1e-5.
  Eigen::Matrix3d expected = Eigen::Vector3d(4e-4, 1e-4, 9e-4).asDiagonal();
  expected(0, 1) = expected(1, 0) = 2.5e-5;
  test::expect_near_matrix(fix.position_cov_n, expected, 2e-5, "covariance");
  files.put("b.pos", names + row);
  EXPECT_NE(refusal([&] { (void)files.gnss("b.pos"); }).find("origin"), std::string::npos);
}

TEST(RtklibPos, GeodeticHeightsAreAboveTheSea) {
  std::string text = kLlhHeader;
  text.replace(text.find("ellipsoidal"), 11, "geodetic");
  text += "2009/04/07 00:00:30.000 35.0 139.0 66.0 1 7 0.01 0.01 0.02 0 0 0 0 0\n";
  const Files files;
  files.put("a.pos", text);
  EXPECT_EQ(count_of(files.gnss("a.pos").events, "msl_height"), 1);
  const auto gnss = files.gnss("a.pos", "geoid_height_m: 36.5");
  EXPECT_EQ(count_of(gnss.events, "msl_height"), 0);
  expect_position(gnss.fixes[0], degrees(35.0, 139.0, 102.5), 1e-6);
}

std::string one_fix(const std::string& sigmas) {
  return fmt::format("{}2009/04/07 00:00:30.000 35.0 139.0 66.0 1 7 {} 0 0\n", kLlhHeader, sigmas);
}

TEST(RtklibPos, ZeroSigmaIsRefusedUnlessStated) {
  const Files files;
  files.put("a.pos", one_fix("0.01 0.0000 0.02 0 0 0"));
  const std::string message = refusal([&] { (void)files.gnss("a.pos"); });
  EXPECT_NE(message.find("a.pos:6: position standard deviation 0"), std::string::npos) << message;
  EXPECT_NE(message.find("sd_m"), std::string::npos);
  const auto gnss = files.gnss("a.pos", "sd_m: [0.1, 0.2, 0.3]");
  test::expect_near_matrix(gnss.fixes[0].position_cov_n, Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal().toDenseMatrix(), 1e-12,
                           "stated");
}

TEST(RtklibPos, CorrelationsBeyondOneByRoundingArePulledBackOthersRefused) {
  const Files files;
  files.put("a.pos", one_fix("0.0010 0.0010 0.0020 0.0011 0 0"));
  const auto gnss = files.gnss("a.pos");
  EXPECT_EQ(count_of(gnss.events, "covariance_pulled_back"), 1);
  const Eigen::Matrix3d cov = gnss.fixes[0].position_cov_n;
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(cov).eigenvalues()[0], 0.0);
  EXPECT_NEAR(cov(0, 0), 1e-6, 1e-18);  // the standard deviations stay
  EXPECT_GT(cov(0, 1) / 1e-6, 0.99);
  files.put("b.pos", one_fix("0.0100 0.0100 0.0200 0.0200 0 0"));
  EXPECT_NE(refusal([&] { (void)files.gnss("b.pos"); }).find("b.pos:6: position covariance that is not positive definite"),
            std::string::npos);
}

TEST(RtklibPos, LinesWithoutSolutionAndVelocitiesWithoutSigmaAreLeftOut) {
  std::string text = kLlhHeader;
  text.insert(text.size() - 1, " vn(m/s) ve(m/s) vu(m/s) sdvn sdve sdvu sdvne sdveu sdvun");
  text += "2009/04/07 00:00:30.000 35.0 139.0 66.0 1.0000 7.0000 0.01 0.01 0.02 0 0 0 0 0 1 2 3 0.1 0.1 0.2 0 0 0\n";
  text += "2009/04/07 00:00:31.000 0.0 0.0 0.0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
  text += "2009/04/07 00:00:32.000 35.0 139.0 66.0 1 7 0.01 0.01 0.02 0 0 0 0 0 1 2 3 0 0 0 0 0 0\n";
  const Files files;
  files.put("a.pos", text);
  const auto gnss = files.gnss("a.pos");
  ASSERT_EQ(gnss.fixes.size(), 2U);
  ASSERT_TRUE(gnss.fixes[0].velocity);
  EXPECT_EQ(gnss.fixes[0].velocity->v_ea_n, Eigen::Vector3d(1.0, 2.0, -3.0));
  EXPECT_FALSE(gnss.fixes[1].velocity);
  EXPECT_EQ(count_of(gnss.events, "no_solution"), 1);
  EXPECT_EQ(count_of(gnss.events, "velocity_left_out"), 1);
  EXPECT_TRUE(files.gnss("a.pos", "velocity_sd_mps: [0.1, 0.1, 0.1]").fixes[1].velocity);
}

TEST(RtklibPos, WithoutHeaderTheUsualFormIsTakenAndSaid) {
  const Files files;
  files.put("a.pos", "2009/04/07 00:00:30.000 35.0 139.0 66.0 1 7 0.01 0.01 0.02 0 0 0 0 0\n");
  const auto gnss = files.gnss("a.pos", "format: rtklib-pos");
  EXPECT_EQ(count_of(gnss.events, "pos_header_missing"), 1);
  expect_position(gnss.fixes[0], degrees(35.0, 139.0, 66.0), 1e-6);
}

TEST(PosWriter, ReadsBackWithinTheDigitsPrinted) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  record::GnssRecording gnss;
  for (int i = 0; i < 50; ++i) {
    record::GnssFix fix;
    fix.t = GpsTime::from_calendar({2025, 12, 31, 23, 59, 55.0}) + 0.2 * i;  // over midnight and the year
    fix.r_ea_e = geo::ecef_from_geodetic(degrees(-33.0 + 0.01 * normal(generator), 179.99 + 0.01 * normal(generator), 12.0));
    Eigen::Matrix3d a;
    for (double& x : a.reshaped()) x = normal(generator);
    fix.position_cov_n = 1e-2 * (a * a.transpose() + 0.1 * Eigen::Matrix3d::Identity());
    fix.velocity = {Eigen::Vector3d(normal(generator), normal(generator), normal(generator)), 1e-2 * fix.position_cov_n};
    fix.quality = FixQuality::kFloat;
    fix.satellites = 8 + i % 3;
    gnss.fixes.push_back(fix);
  }
  const Files files;
  write_gnss_pos(files.path("a.pos"), gnss);
  const auto back = files.gnss("a.pos");
  ASSERT_EQ(back.fixes.size(), gnss.fixes.size());
  for (std::size_t i = 0; i < gnss.fixes.size(); ++i) {
    const auto& a = gnss.fixes[i];
    const auto& b = back.fixes[i];
    EXPECT_EQ(a.t, b.t);
    EXPECT_LT((a.r_ea_e - b.r_ea_e).norm(), 1e-4);  // half of 1e-9 deg twice and of 1e-4 m
    // Roots to half of 1e-5 m: twice that times the largest root of some 0.3 m.
    EXPECT_LT((a.position_cov_n - b.position_cov_n).cwiseAbs().maxCoeff(), 1e-5 * std::sqrt(a.position_cov_n.trace()));
    ASSERT_TRUE(b.velocity);
    EXPECT_LT((a.velocity->v_ea_n - b.velocity->v_ea_n).norm(), 1e-5);
    EXPECT_LT((a.velocity->cov_n - b.velocity->cov_n).cwiseAbs().maxCoeff(),
              1e-5 * std::sqrt(a.velocity->cov_n.trace()) + 1e-10);
    EXPECT_EQ(a.quality, b.quality);
    EXPECT_EQ(a.satellites, b.satellites);
  }
}

// A simulation without errors to speak of writes sigmas of micrometres.
TEST(RtklibPos, SmallSigmasKeepTheirDigits) {
  record::GnssRecording gnss;
  for (const double sd : {3e-4, 1e-6, 2.5e-8}) {
    record::GnssFix fix;
    fix.t = GpsTime::from_week(2374, 208800.0 + static_cast<double>(gnss.fixes.size()));
    fix.r_ea_e = geo::ecef_from_geodetic(degrees(46.5123456789123, -106.5123456789123, 412.123456789));
    Eigen::Matrix3d correlation;
    correlation << 1.0, 0.9, 0.0, 0.9, 1.0, -0.3, 0.0, -0.3, 1.0;
    fix.position_cov_n = sd * sd * correlation;
    fix.velocity = {Eigen::Vector3d(1.23456789, -0.5, 0.25), 0.01 * fix.position_cov_n};
    fix.quality = FixQuality::kFixed;
    gnss.fixes.push_back(fix);
  }
  const Files files;
  write_gnss_pos(files.path("a.pos"), gnss);
  const auto back = files.gnss("a.pos");
  ASSERT_EQ(back.fixes.size(), gnss.fixes.size());
  for (std::size_t i = 1; i < gnss.fixes.size(); ++i) {
    const auto& a = gnss.fixes[i];
    const auto& b = back.fixes[i];
    const double variance = a.position_cov_n(0, 0);
    // Half of the fourth digit of a root: 1e-3 of a variance.
    EXPECT_LT((a.position_cov_n - b.position_cov_n).cwiseAbs().maxCoeff(), 1e-3 * variance);
    ASSERT_TRUE(b.velocity);
    EXPECT_LT((a.velocity->cov_n - b.velocity->cov_n).cwiseAbs().maxCoeff(), 1e-3 * 0.01 * variance);
    // A nanometre is what ECEF and back leaves; digits leave less than a tenth of the sigma.
    EXPECT_LT((a.r_ea_e - b.r_ea_e).norm(), 0.1 * std::sqrt(variance) + 1e-8);
    EXPECT_LT((a.velocity->v_ea_n - b.velocity->v_ea_n).norm(), 0.01 * std::sqrt(variance));
  }
}

TEST(KfGinsGnss, WithAndWithoutVelocity) {
  const Files files;
  files.put("a.txt", "456300.0 30.5 114.3 20.0 0.01 0.02 0.03\n456301.0 30.5 114.3 20.0 0.01 0.02 0.03\n");
  const auto gnss = files.gnss("a.txt", "gps_week: 2017");
  ASSERT_EQ(gnss.fixes.size(), 2U);
  expect_position(gnss.fixes[1], degrees(30.5, 114.3, 20.0), 1e-6);
  test::expect_near_matrix(gnss.fixes[0].position_cov_n, Eigen::Vector3d(1e-4, 4e-4, 9e-4).asDiagonal().toDenseMatrix(), 1e-12,
                           "sd");
  files.put("b.txt", "456300.0 30.5 114.3 20.0 0.01 0.02 0.03 1 2 3 0.1 0.2 0.3\n");
  EXPECT_EQ(files.gnss("b.txt", "gps_week: 2017").fixes[0].velocity->v_ea_n, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(GnssTable, EveryFrameGivesTheSamePoint) {
  // A published point: CN Tower, 43 38 33.24 N 79 23 13.7 W is UTM 17N 630084 E 4833438 N.
  const geo::Geodetic tower = degrees(43.0 + 38.0 / 60.0 + 33.24 / 3600.0, -(79.0 + 23.0 / 60.0 + 13.7 / 3600.0), 76.0);
  const Eigen::Vector3d r = geo::ecef_from_geodetic(tower);
  const std::string keys = "gps_week: 2300, sd_m: [1, 1, 1], columns: {time: t, position: [a, b, c]}, ";
  const Files files;
  const auto read = [&](const std::string& values, const std::string& frame) {
    files.put("t.csv", "t,a,b,c\n10," + values + "\n11," + values + "\n");
    return files.gnss("t.csv", keys + frame).fixes.at(0).r_ea_e;
  };
  EXPECT_LT(
      (read(fmt::format("{:.9f},{:.9f},76", tower.latitude / geo::kDegree, tower.longitude / geo::kDegree), "frame: geodetic") -
       r)
          .norm(),
      1e-3);
  EXPECT_LT((read(fmt::format("{:.4f},{:.4f},{:.4f}", r.x(), r.y(), r.z()), "frame: ecef") - r).norm(), 1e-3);
  EXPECT_LT((read("630084,4833438,76", "frame: utm, utm_zone: 17N") - r).norm(), 1.0);  // published to the metre
  const std::string origin =
      fmt::format(", origin_deg_m: [{:.12f}, {:.12f}, 76]", tower.latitude / geo::kDegree, tower.longitude / geo::kDegree);
  const Eigen::Matrix3d C = geo::C_n_e(tower);
  EXPECT_LT((read("30,40,-5", "frame: ned" + origin) - (r + C * Eigen::Vector3d(30.0, 40.0, -5.0))).norm(), 1e-6);
  EXPECT_LT((read("40,30,5", "frame: enu" + origin) - (r + C * Eigen::Vector3d(30.0, 40.0, -5.0))).norm(), 1e-6);
}

TEST(GnssTable, QuotedLogWithVelocityAndQuality) {
  const Files files;
  files.put("log.csv",
            "time(ms),when,lat,lon,alt(m), vn, ve, vd,sats,q,note\n"
            "100,2022-07-07 08:10:25,32.8,34.9,5.5,0.1,0.2,0.3,17,1,\"a, b\"\n"
            "200,2022-07-07 08:10:25,32.8,34.9,5.6,0.1,0.2,0.3,18,9,\n");
  const auto gnss =
      files.gnss("log.csv",
                 "columns: {time: 'time(ms)', position: [lat, lon, alt(m)], velocity: [vn, ve, vd], satellites: sats, "
                 "quality: q}, time: {kind: elapsed, unit: ms, offset_s: 500}, gps_week: 2217, height: msl, "
                 "sd_m: [1, 1, 2], velocity_sd_mps: [0.1, 0.1, 0.2]");
  ASSERT_EQ(gnss.fixes.size(), 2U);
  EXPECT_EQ(gnss.fixes[1].t, GpsTime::from_week(2217, 500.2));
  EXPECT_EQ(gnss.fixes[1].satellites, 18);
  EXPECT_EQ(gnss.fixes[0].quality, FixQuality::kFixed);
  EXPECT_EQ(gnss.fixes[1].quality, FixQuality::kUnknown);
  EXPECT_EQ(gnss.fixes[0].velocity->v_ea_n, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(count_of(gnss.events, "msl_height"), 1);
}

TEST(GnssTable, WhatIsMissingIsAskedFor) {
  const Files files;
  files.put("t.csv", "t,a,b,c\n10,35,139,5\n11,35,139,5\n");
  const auto message = [&](const std::string& keys) { return refusal([&] { (void)files.gnss("t.csv", keys); }); };
  const std::string columns = "columns: {time: t, position: [a, b, c]}";
  EXPECT_NE(message(columns + ", gps_week: 2300").find("sd_m"), std::string::npos);
  EXPECT_NE(message(columns + ", sd_m: [1, 1, 1]").find("gps_week"), std::string::npos);
  EXPECT_NE(message(columns + ", sd_m: [1, 1, 1], frame: utm").find("utm_zone"), std::string::npos);
  EXPECT_NE(message(columns + ", sd_m: [1, 1, 1], frame: ned").find("origin_deg_m"), std::string::npos);
  EXPECT_NE(message(columns + ", sd_m: [1, 0, 1]").find("not positive"), std::string::npos);
  EXPECT_NE(message(columns + ", sd_m: [1, 1, 1], gps_week: 2300, frame: ecef").find("t.csv:2:"), std::string::npos);
  EXPECT_NE(
      message("columns: {time: t, position: [b, a, c]}, sd_m: [1, 1, 1], gps_week: 2300").find("t.csv:2: latitude 139 deg"),
      std::string::npos);
}

}  // namespace
}  // namespace coast::io
