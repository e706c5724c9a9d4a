// DataFlash logs of known content.

#include <gtest/gtest.h>

#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/contents.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/receiver_messages.hpp"

namespace coast::io {
namespace {

using test::Bytes;
using test::Files;
using test::refusal;

std::string df_text(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

std::string df_message(unsigned kind, const Bytes& fields) {
  return Bytes().u1(0xa3).u1(0x95).u1(kind).text(fields.str()).str();
}

std::string df_format(unsigned kind, unsigned size, const std::string& name, const std::string& types,
                      const std::string& names) {
  return df_message(0x80, Bytes().u1(kind).u1(size).text(df_text(name, 4)).text(df_text(types, 16)).text(df_text(names, 64)));
}

const std::string kDfFormats =
    df_format(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns") +
    df_format(20, 36, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ") +
    df_format(21, 51, "GPS", "QBBIHBcLLeffffB", "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U") +
    df_format(22, 35, "GPA", "QBCCCCfBIHf", "TimeUS,I,VDop,HAcc,VAcc,SAcc,YAcc,VV,SMS,Delta,Und") +
    df_format(23, 13, "ODD", "Q?", "TimeUS,X");

constexpr unsigned kDfWeek = 2288;
constexpr std::uint32_t kDfMs = 252'818'000;

std::string df_imu(std::uint64_t us, float value, unsigned instance = 0) {
  return df_message(20, Bytes().put<std::uint64_t>(us).u1(instance).r4(1.0F).r4(value).r4(0.25F).r4(0.5F).r4(-0.5F).r4(-9.75F));
}

struct DfGps {
  std::uint64_t us = 10'000'000;
  std::uint32_t ms = kDfMs;
  unsigned week = kDfWeek, status = 3, instance = 0, vertical = 1;
  float und = -47.5F;
  unsigned h_acc = 141, v_acc = 200, s_acc = 30;
};

std::string df_gps(const DfGps& g) {
  Bytes b, a;
  b.put<std::uint64_t>(g.us).u1(g.instance).u1(g.status).u4(g.ms).u2(g.week).u1(14).u2(80);
  b.i4(473'977'420).i4(85'455'940).i4(51'234).r4(5.0F).r4(90.0F).r4(0.5F).r4(0.0F).u1(1);
  a.put<std::uint64_t>(g.us).u1(g.instance).u2(100).u2(g.h_acc).u2(g.v_acc).u2(g.s_acc).r4(0.0F).u1(g.vertical);
  return df_message(21, b) + df_message(22, a.u4(1).u2(200).r4(g.und));
}

/// IMU at 100 Hz, positions at 5 Hz that arrive 100 ms late.
std::string df_flight(int seconds) {
  std::string content;
  for (int i = 0; i < 100 * seconds; ++i) {
    const auto us = 10'000'000U + 10'000U * static_cast<unsigned>(i);
    content += df_imu(us, static_cast<float>(i)) + df_imu(us, -1.0F, 1);
    if (i % 20 != 0) continue;
    content += df_gps({.us = us + 100'000U, .ms = kDfMs + 10U * static_cast<unsigned>(i)});
    content += df_gps({.us = us + 120'000U, .ms = kDfMs + 10U * static_cast<unsigned>(i), .instance = 1});
  }
  return content;
}

TEST(DataflashLog, HasItsImuInGpsTime) {
  const Files files;
  files.put_gzip("log.bin.gz", kDfFormats + df_flight(4));
  const auto imu = files.imu("log.bin.gz");
  ASSERT_EQ(imu.samples.size(), 400U);
  EXPECT_NEAR(imu.rate_hz, 100.0, 1e-9);
  const record::ImuSample& s = imu.samples[150];
  EXPECT_NEAR(s.t - (geo::GpsTime::from_week(kDfWeek, 1e-3 * kDfMs) + 1.4), 0.0, 2e-9);  // early by what messages are late
  EXPECT_LT((s.dtheta / s.dt - Eigen::Vector3d(1.0, 150.0, 0.25)).norm(), 1e-9);
  EXPECT_LT((s.dv / s.dt - Eigen::Vector3d(0.5, -0.5, -9.75)).norm(), 1e-12);
  EXPECT_EQ(test::count_of(imu.events, "imu_clock_tied"), 1);
  EXPECT_EQ(test::count_of(imu.events, "log_undefined"), 1);
}

TEST(DataflashLog, HasItsPositions) {
  const Files files;
  files.put("log.bin", kDfFormats + df_gps({}) + df_gps({.ms = kDfMs + 200, .status = 2}) + df_gps({.week = 0}) +
                           df_gps({.ms = kDfMs + 400, .h_acc = 0}) + df_gps({.ms = kDfMs + 600, .status = 6, .vertical = 0}) +
                           df_gps({.ms = kDfMs + 700, .instance = 1}));
  const auto gnss = files.gnss("log.bin");
  ASSERT_EQ(gnss.fixes.size(), 2U);
  const record::GnssFix& fix = gnss.fixes[0];
  EXPECT_EQ(fix.t, geo::GpsTime::from_week(kDfWeek, 1e-3 * kDfMs));
  const geo::Geodetic place{47.397742 * geo::kDegree, 8.545594 * geo::kDegree, 512.34 + 47.5};
  EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic(place)).norm(), 1e-6);
  EXPECT_LT((fix.position_cov_n.diagonal() - Eigen::Vector3d(0.99405, 0.99405, 4.0)).norm(), 1e-9);
  EXPECT_LT((fix.velocity->v_ea_n - Eigen::Vector3d(0.0, 5.0, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(fix.velocity->cov_n.trace(), 0.09, 1e-9);
  EXPECT_EQ(fix.quality, record::FixQuality::kSingle);
  EXPECT_EQ(fix.satellites, 14);
  EXPECT_EQ(gnss.fixes[1].quality, record::FixQuality::kFixed);
  EXPECT_FALSE(gnss.fixes[1].velocity);
  for (const char* kind : {"no_solution", "fix_no_time", "fix_no_accuracy"})
    EXPECT_EQ(test::count_of(gnss.events, kind), 1) << kind;
  EXPECT_EQ(test::count_of(gnss.events, "msl_height"), 0);
}

TEST(DataflashLog, WithoutTheGeoidSaysSo) {
  const Files files;
  files.put("log.bin", kDfFormats + df_gps({.und = 0.0F}));
  const auto gnss = files.gnss("log.bin");
  EXPECT_EQ(test::count_of(gnss.events, "msl_height"), 1);
  EXPECT_NEAR(geo::geodetic_from_ecef(gnss.fixes[0].r_ea_e).height, 512.34, 1e-6);
  const auto stated = files.gnss("log.bin", "height: msl, geoid_height_m: 40");
  EXPECT_NEAR(geo::geodetic_from_ecef(stated.fixes[0].r_ea_e).height, 552.34, 1e-6);
  EXPECT_EQ(test::count_of(stated.events, "msl_height"), 0);
}

TEST(DataflashLog, PairsGyroAndAccelerometerWhereTheyHaveMore) {
  std::string content = kDfFormats + df_format(30, 32, "GYR", "QBQfff", "TimeUS,I,SampleUS,GyrX,GyrY,GyrZ") +
                        df_format(31, 32, "ACC", "QBQfff", "TimeUS,I,SampleUS,AccX,AccY,AccZ") + df_flight(2);
  for (int i = 0; i < 1000; ++i) {
    const auto us = 10'000'000U + 1000U * static_cast<unsigned>(i);
    for (const unsigned kind : {30U, 31U})
      content += df_message(kind, Bytes()
                                      .put<std::uint64_t>(us + 5000)
                                      .u1(0)
                                      .put<std::uint64_t>(us + (kind == 31 ? 250U : 0U))
                                      .r4(static_cast<float>(i))
                                      .r4(0.5F)
                                      .r4(-0.25F));
  }
  const Files files;
  files.put("log.bin", content);
  const auto imu = files.imu("log.bin");
  ASSERT_EQ(imu.samples.size(), 999U);
  const record::ImuSample& s = imu.samples[9];  // of gyro 10
  EXPECT_NEAR(s.dtheta.x() / s.dt, 10.0, 1e-6);
  EXPECT_NEAR(s.dv.x() / s.dt, 9.75, 1e-6);
}

TEST(DataflashLog, OfOldVersionsIsRead) {
  std::string content =
      df_format(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns") +
      df_format(20, 31, "IMU", "Iffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ") +
      df_format(24, 31, "IMU2", "Iffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ") +
      df_format(21, 45, "GPS", "BIHBcLLeeEefI", "Status,TimeMS,Week,NSats,HDop,Lat,Lng,RelAlt,Alt,Spd,GCrs,VZ,T");
  for (unsigned i = 0; i < 200; ++i) {
    for (const unsigned kind : {20U, 24U})
      content += df_message(kind, Bytes().u4(5000 + 20 * i).r4(static_cast<float>(kind)).r4(0).r4(0).r4(0).r4(0).r4(-9.75F));
    if (i % 10 == 0)
      content += df_message(21, Bytes()
                                    .u1(3)
                                    .u4(kDfMs + 20 * i)
                                    .u2(1800)
                                    .u1(9)
                                    .u2(120)
                                    .i4(473'977'420)
                                    .i4(85'455'940)
                                    .i4(100)
                                    .i4(51'234)
                                    .u4(500)
                                    .i4(18000)
                                    .r4(-0.5F)
                                    .u4(5000 + 20 * i));
  }
  const Files files;
  files.put("log.bin", content);
  const auto imu = files.imu("log.bin");
  ASSERT_EQ(imu.samples.size(), 200U);
  EXPECT_NEAR(imu.samples[100].dtheta.x() / imu.samples[100].dt, 20.0, 1e-9);
  EXPECT_NEAR(imu.samples[100].t - (geo::GpsTime::from_week(1800, 1e-3 * kDfMs) + 2.0), 0.0, 1e-6);
  const auto gnss = files.gnss("log.bin", "sd_m: [2, 2, 4], velocity_sd_mps: [1, 1, 1]");
  EXPECT_EQ(gnss.fixes.size(), 20U);
  EXPECT_LT((gnss.fixes[0].velocity->v_ea_n - Eigen::Vector3d(-5.0, 0.0, -0.5)).norm(), 1e-9);
}

TEST(DataflashLog, HasTheNumbersOfAnotherReader) {
  const Files files;
  const auto file = files.put("log.bin", kDfFormats + df_flight(4));
  const auto lines = test::lines_of_script("dataflash_table.py", file);
  if (lines.empty()) GTEST_SKIP() << "no python3 here";
  const auto imu = files.imu("log.bin");
  const auto gnss = files.gnss("log.bin");
  std::size_t samples = 0, fixes = 0;
  for (const std::string& line : lines) {
    std::istringstream fields(line);
    std::string kind;
    std::vector<double> v;
    fields >> kind;
    for (double value = 0.0; fields >> value;) v.push_back(value);
    if (kind == "imu") {
      ASSERT_LT(samples, imu.samples.size());
      const record::ImuSample& s = imu.samples[samples++];
      EXPECT_LT((s.dtheta / s.dt - Eigen::Vector3d(v[1], v[2], v[3])).norm(), 1e-9);
      EXPECT_LT((s.dv / s.dt - Eigen::Vector3d(v[4], v[5], v[6])).norm(), 1e-9);
    } else if (kind == "gps") {
      ASSERT_LT(fixes, gnss.fixes.size());
      const record::GnssFix& fix = gnss.fixes[fixes++];
      EXPECT_EQ(fix.t, geo::GpsTime::from_week(static_cast<int>(v[1]), 1e-3 * v[2]));
      const geo::Geodetic p = geo::geodetic_from_ecef(fix.r_ea_e);
      EXPECT_NEAR(p.latitude / geo::kDegree, v[4], 1e-12);
      EXPECT_NEAR(p.longitude / geo::kDegree, v[5], 1e-12);
    } else {
      const record::GnssFix& fix = gnss.fixes.at(fixes - 1);
      EXPECT_NEAR(fix.position_cov_n(2, 2), v[2] * v[2], 1e-9);
      EXPECT_NEAR(geo::geodetic_from_ecef(fix.r_ea_e).height, 512.34 - v[4], 1e-6);
    }
  }
  EXPECT_EQ(samples, 400U);
  EXPECT_EQ(fixes, 20U);
}

TEST(DataflashLog, GoesOnAfterDamage) {
  const Files files;
  std::string dropped = df_format(40, 13, "DSF", "QH", "TimeUS,Dp") + df_message(40, Bytes().put<std::uint64_t>(1).u2(6));
  files.put("log.bin", kDfFormats + dropped + df_flight(3) + df_imu(13'000'000, 1.0F) + std::string("\xa3\x95\x14", 3) +
                           std::string(50, '\xff') + df_message(99, Bytes().zeros(20)) + df_imu(13'010'000, 1.0F) +
                           df_imu(13'020'000, 1.0F).substr(0, 20));
  const auto imu = files.imu("log.bin");
  // What looks like a message, but is not followed by one, is none.
  EXPECT_EQ(imu.samples.size(), 302U);
  EXPECT_EQ(test::count_of(imu.events, "message_garbage"), 3 + 50 + 23);
  EXPECT_EQ(test::count_of(imu.events, "message_cut_off"), 1);
  EXPECT_EQ(test::count_of(imu.events, "log_dropout"), 6);
}

TEST(DataflashLog, ThatCannotBeReadIsRefused) {
  const Files files;
  const auto imu = [&](const std::string& content) {
    files.put("log.bin", content);
    return refusal([&] { (void)files.imu("log.bin", "format: dataflash"); });
  };
  EXPECT_NE(imu("text").find("no message FMT at its beginning"), std::string::npos);
  EXPECT_NE(imu(kDfFormats).find("a log with 0 IMU samples"), std::string::npos);
  std::string without = kDfFormats;
  for (unsigned i = 0; i < 20; ++i) without += df_imu(10'000U * i, 0.0F);
  EXPECT_NE(imu(without).find("fewer than ten positions with GPS time"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.gnss("log.bin"); }).find("a log without positions"), std::string::npos);
  const auto contents = read_contents(files.path("log.bin"));
  ASSERT_EQ(contents.messages.size(), 1U);
  EXPECT_EQ(contents.messages[0].name, "IMU");
}

}  // namespace
}  // namespace coast::io
