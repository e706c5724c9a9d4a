#include "coast/io/imu.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "coast/geo/units.hpp"
#include "coast/io/writers.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using geo::GpsTime;
using test::count_of;
using test::Files;
using test::refusal;

constexpr double kRounding = 1e-15;  // a few units in the last place of increments of at most 0.1

constexpr const char* kHeader = "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";

/// Rows of the default CSV at 100 Hz from 100 s; rate about z is linear in time, 0.1 (t - 100) rad/s.
std::string default_csv(const std::vector<int>& ticks) {
  std::string text = kHeader;
  for (const int k : ticks) text += fmt::format("{:.2f},0.01,0.02,{:.4f},1,2,-9.8\n", 100.0 + 0.01 * k, 0.001 * k);
  return text;
}

std::vector<int> range(int n) {
  std::vector<int> v;
  for (int i = 0; i < n; ++i) v.push_back(i);
  return v;
}

TEST(ImuCsv, RatesBecomeIncrementsOverIntervalsThatTileTime) {
  const Files files;
  files.put("imu.csv", default_csv(range(20)));
  const auto imu = files.imu("imu.csv", "gps_week: 2300");
  ASSERT_EQ(imu.samples.size(), 20U);
  EXPECT_NEAR(imu.rate_hz, 100.0, 1e-6);
  EXPECT_EQ(imu.samples[0].t, GpsTime::from_week(2300, 100.0));
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const auto& s = imu.samples[i];
    EXPECT_NEAR(s.dt, 0.01, 1e-9);
    test::expect_near_matrix(s.dtheta, Eigen::Vector3d(1e-4, 2e-4, 1e-5 * static_cast<double>(i)), 1e-7, "dtheta");
    test::expect_near_matrix(s.dv, Eigen::Vector3d(0.01, 0.02, -0.098), 1e-7, "dv");
    if (i > 0) {
      EXPECT_NEAR(s.t - imu.samples[i - 1].t, s.dt, kRounding);
    }
  }
  EXPECT_TRUE(imu.events.empty());
}

// 152.4 Hz on a clock of milliseconds: most steps are of 6 ms, which would be 166.67 Hz. A gap of a second counts for nothing.
TEST(ImuCsv, RateIsThatOfTheSamplesAndNotOfTheClock) {
  std::string text = kHeader;
  for (int k = 0; k < 1000; ++k)
    text += fmt::format("{:.3f},0,0,0,0,0,-9.8\n", 100.0 + (k < 500 ? 0.0 : 1.0) + 1e-3 * std::floor(6.5625 * k));
  const Files files;
  files.put("imu.csv", text);
  const auto imu = files.imu("imu.csv", "gps_week: 2300");
  EXPECT_NEAR(imu.rate_hz, 1000.0 / 6.5625, 0.05);  // both ends of 500 steps are rounded by a millisecond
  EXPECT_EQ(count_of(imu.events, "imu_gap"), 1);
}

TEST(ImuCsv, AGapIsBridgedByLinearRates) {
  const Files files;
  files.put("imu.csv", default_csv({0, 1, 2, 3, 7, 8, 9}));
  const auto imu = files.imu("imu.csv", "gps_week: 2300");
  ASSERT_EQ(imu.samples.size(), 7U);
  EXPECT_EQ(count_of(imu.events, "imu_gap"), 1);
  const auto& bridged = imu.samples[4];
  EXPECT_NEAR(bridged.dt, 0.04, 1e-9);
  // The sample itself (0.007 over 0.01 s), and the mean of the neighbours (0.003, 0.007) over the 0.03 s before it.
  EXPECT_NEAR(bridged.dtheta.z(), 0.007 * 0.01 + 0.005 * 0.03, 1e-11);
  EXPECT_NEAR(bridged.dv.z(), -9.8 * 0.04, 1e-8);
}

TEST(ImuCsv, TimeTagsOfCentreAndStartMoveToTheEnd) {
  const Files files;
  files.put("imu.csv", default_csv(range(5)));
  const auto end = files.imu("imu.csv", "gps_week: 2300");
  const auto centre = files.imu("imu.csv", "gps_week: 2300, time_tag: centre");
  const auto start = files.imu("imu.csv", "gps_week: 2300, time_tag: start");
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(centre.samples[i].t - end.samples[i].t, 0.005, 1e-9);
    EXPECT_NEAR(start.samples[i].t - end.samples[i].t, 0.01, 1e-9);
  }
}

TEST(ImuCsv, MappedColumnsUnitsScalesAndMilliseconds) {
  const Files files;
  files.put("raw.csv", "0.5,0,-1,2,4,-6,261906\n0.5,0,-1,2,4,-6,261916\n0.5,0,-1,2,4,-6,261926\n");
  const auto imu = files.imu("raw.csv",
                             "columns: {time: 7, accel: [1, 2, 3], gyro: [4, 5, 6]}, units: {accel: g, gyro: deg/s}, "
                             "scale: {gyro: 0.5}, time: {kind: elapsed, unit: ms, offset_s: 1000}, gps_week: 2374");
  ASSERT_EQ(imu.samples.size(), 3U);
  EXPECT_EQ(imu.samples[1].t, GpsTime::from_week(2374, 1261.916));
  const double dt = 0.01;
  test::expect_near_matrix(imu.samples[1].dv, 9.80665 * dt * Eigen::Vector3d(0.5, 0.0, -1.0), 1e-12, "dv");
  test::expect_near_matrix(imu.samples[1].dtheta, 3.14159265358979 / 180.0 * dt * Eigen::Vector3d(1.0, 2.0, -3.0), 1e-12,
                           "dtheta");
}

TEST(ImuCsv, OneOfSeveralImusByName) {
  const Files files;
  files.put("two.csv",
            "time_s,imu1_ax,imu1_ay,imu1_az,imu1_gx,imu1_gy,imu1_gz,imu2_ax,imu2_ay,imu2_az,imu2_gx,imu2_gy,imu2_gz\n"
            "0,1,1,1,1,1,1,2,3,4,5,6,7\n0.5,1,1,1,1,1,1,2,3,4,5,6,7\n");
  const auto imu = files.imu("two.csv",
                             "columns: {time: time_s, accel: [imu2_ax, imu2_ay, imu2_az], gyro: [imu2_gx, imu2_gy, imu2_gz]}, "
                             "gps_week: 1");
  EXPECT_EQ(imu.samples[0].dv, Eigen::Vector3d(1.0, 1.5, 2.0));
  EXPECT_EQ(imu.samples[0].dtheta, Eigen::Vector3d(2.5, 3.0, 3.5));
}

TEST(ImuTime, EveryKindGivesTheSameInstant) {
  // 2025-07-08 19:34:18.5 GPST is week 2374, second 243258.5; UTC is 18 s behind (leap seconds since 2017).
  const GpsTime expected = GpsTime::from_week(2374, 243258.5);
  const Files files;
  const std::string rest = ",0.1,0.2,0.3,1,2,-9.8\n";
  struct Case {
    const char* first;
    const char* second;
    const char* keys;
  };
  for (const Case& c : {Case{"243258.5", "243259.5", "gps_week: 2374"},
                        Case{"2025-07-08 19:34:18.5", "2025-07-08 19:34:19.5", "time: {kind: gpst}"},
                        Case{"2025/07/08T19:34:00.5Z", "2025/07/08T19:34:01.5Z", "time: {kind: utc}"},
                        Case{"1752003240.5", "1752003241.5", "time: {kind: unix}"},
                        Case{"58500", "59500", "time: {kind: elapsed, unit: ms, offset_s: 243200}, gps_week: 2374"}}) {
    files.put("t.csv", "t,a,b,c,d,e,f\n" + (c.first + rest) + (c.second + rest));
    const auto imu = files.imu("t.csv", std::string("columns: {time: t, gyro: [a, b, c], accel: [d, e, f]}, ") + c.keys);
    EXPECT_NEAR(imu.samples[0].t - expected, 0.0, 1e-6) << c.first;
  }
  files.put("t.csv", "w,t,a,b,c,d,e,f\n2374,243258.5" + rest + "2374,243259.5" + rest);
  const auto imu = files.imu("t.csv", "columns: {time: [w, t], gyro: [a, b, c], accel: [d, e, f]}, time: {kind: week_sow}");
  EXPECT_EQ(imu.samples[0].t, expected);
  files.put("t.csv", "a,b,c,d,e,f\n" + rest.substr(1) + rest.substr(1));
  const auto rows = files.imu("t.csv",
                              "columns: {gyro: [a, b, c], accel: [d, e, f]}, gps_week: 2374, "
                              "time: {kind: row, rate_hz: 4, offset_s: 243258.5}");
  EXPECT_EQ(rows.samples[0].t, expected);
  EXPECT_EQ(rows.samples[1].t, expected + 0.25);
}

TEST(ImuTime, WeekComesFromThePartnerAndRollsOver) {
  const Files files;
  std::string text = kHeader;
  for (int k = -5; k < 5; ++k) text += fmt::format("{:.2f},0.1,0,0,0,0,-9.8\n", k < 0 ? 604800.0 + 0.01 * k : 0.01 * k);
  files.put("imu.csv", text);
  // The partner begins after the rollover, the IMU before it.
  const auto imu = files.imu("imu.csv", "", GpsTime::from_week(2301, 3.0));
  ASSERT_EQ(imu.samples.size(), 10U);
  EXPECT_EQ(imu.samples.front().t, GpsTime::from_week(2300, 604799.95));
  EXPECT_EQ(imu.samples.back().t, GpsTime::from_week(2301, 0.04));
  EXPECT_EQ(count_of(imu.events, "week_rollover"), 1);
  EXPECT_EQ(count_of(imu.events, "imu_gap"), 0);
  EXPECT_NE(refusal([&] { (void)files.imu("imu.csv"); }).find("gps_week"), std::string::npos);
}

TEST(ImuRepairs, AreCountedWithTheirFirstPlace) {
  const Files files;
  std::string text = kHeader;
  text += "99.98,0,0,0,0,0,0\n";  // zeros before the sensor measures
  for (int k = 0; k < 400; ++k) {
    const std::string row = fmt::format("{:.2f},0.01,0.02,{:.4f},1,2,-9.8\n", 100.0 + 0.01 * k, 0.001 * k);
    text += row;
    if (k == 50) text += row;                                                       // the same row again
    if (k == 60) text += fmt::format("{:.2f},0,0,0,1,2,-9.8\n", 100.0 + 0.01 * k);  // the same time, other values
    if (k == 70) text += "100.705,nan,0,0,1,2,-9.8\n";
    if (k == 80) text += "100.795,0,0,0,1,2,-9.8\n";  // back by less than a sample
  }
  files.put("imu.csv", text);
  const auto imu = files.imu("imu.csv", "gps_week: 2300");
  EXPECT_EQ(imu.samples.size(), 400U);
  for (const char* kind : {"imu_zero_row", "repeated_row", "repeated_time", "nan_row", "time_back"})
    EXPECT_EQ(count_of(imu.events, kind), 1) << kind;
  const auto it = std::find_if(imu.events.begin(), imu.events.end(), [](const auto& e) { return e.kind == "repeated_row"; });
  EXPECT_NE(it->text.find("first at line 54"), std::string::npos) << it->text;
}

TEST(ImuRepairs, TooManyAreRefused) {
  const Files files;
  std::string text = kHeader;
  for (int k = 0; k < 100; ++k) text += fmt::format("{:.2f},{},0,0,1,2,-9.8\n", 100.0 + 0.01 * k, k % 5 == 4 ? "nan" : "0.1");
  files.put("imu.csv", text);
  EXPECT_NE(refusal([&] { (void)files.imu("imu.csv", "gps_week: 2300"); }).find("imu.csv:6:"), std::string::npos);
}

TEST(ImuErrors, TimeGoingBackNamesLineAndTimes) {
  const Files files;
  auto ticks = range(10);
  for (const int k : {-420, -419}) ticks.push_back(k);
  files.put("imu.csv", default_csv(ticks));
  EXPECT_NE(
      refusal([&] { (void)files.imu("imu.csv", "gps_week: 2300"); })
          .find("imu.csv:12: time goes back by 4.290 s (95.800 after 100.090), expected increasing. Two recordings in one "
                "file? Split it here."),
      std::string::npos);
}

TEST(ImuKfGins, IncrementsAreRecognisedAndKept) {
  const Files files;
  files.put("imu.txt",
            "456300.005 1e-5 -2e-5 3e-5 0.001 0.002 -0.049\n456300.010 1e-5 -2e-5 3e-5 0.001 0.002 -0.049\n"
            "456300.015 4e-5 -2e-5 3e-5 0.001 0.002 -0.049\n");
  const auto imu = files.imu("imu.txt", "gps_week: 2017");
  ASSERT_EQ(imu.samples.size(), 3U);
  EXPECT_NEAR(imu.rate_hz, 200.0, 1e-6);
  test::expect_near_matrix(imu.samples[2].dtheta, Eigen::Vector3d(4e-5, -2e-5, 3e-5), 1e-15, "dtheta");
  test::expect_near_matrix(imu.samples[2].dv, Eigen::Vector3d(0.001, 0.002, -0.049), 1e-15, "dv");
}

TEST(ImuWriter, ReadsBackWithinTheDigitsPrinted) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  record::ImuRecording imu;
  for (int i = 0; i < 200; ++i) {
    record::ImuSample s;
    s.dt = 1.0 / 128.0;
    s.t = GpsTime::from_week(2300, 604799.0) + static_cast<double>(i + 1) * s.dt;  // across a rollover
    s.dtheta = 0.01 * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    s.dv = 0.1 * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    imu.samples.push_back(s);
    imu.temperature.push_back(20.0F + 0.01F * static_cast<float>(i));
  }
  const Files files;
  write_imu_csv(files.path("imu.csv"), imu);
  const auto back = files.imu("imu.csv", "gps_week: 2300");
  ASSERT_EQ(back.samples.size(), imu.samples.size());
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    EXPECT_EQ(back.samples[i].t, imu.samples[i].t);
    // Half a digit of 1e-13 rad/s and 1e-12 m/s^2 over 1/128 s, and the interval, whole nanoseconds in the file.
    EXPECT_LT((back.samples[i].dtheta - imu.samples[i].dtheta).norm(), 1e-9 * 0.05);
    EXPECT_LT((back.samples[i].dv - imu.samples[i].dv).norm(), 1e-9 * 50.0);
    EXPECT_NEAR(back.temperature[i], imu.temperature[i], 6e-4);
  }
}

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

TEST(ImuBinary, CountsWithScaleAndRowTimes) {
  std::string bytes = "HDR!";
  for (int row = 0; row < 4; ++row)
    for (const int count : {10, -20, 30, 1000, -2000, 300 + row}) append(bytes, static_cast<std::int16_t>(count));
  bytes += "xyz";  // a torn record
  const Files files;
  files.put("raw.bin", bytes);
  const std::string keys =
      "format: binary, binary: {type: i16, row: 6, header_bytes: 4}, columns: {gyro: [1, 2, 3], accel: [4, 5, 6]}, "
      "units: {gyro: deg/s, accel: g}, scale: {gyro: 0.05, accel: 0.00333}, gps_week: 2000, time: {kind: row, rate_hz: 100}";
  const auto imu = files.imu("raw.bin", keys);
  ASSERT_EQ(imu.samples.size(), 4U);
  EXPECT_EQ(imu.samples[2].t, GpsTime::from_week(2000, 0.02));
  test::expect_near_matrix(imu.samples[2].dtheta, 0.05 * 3.14159265358979 / 180.0 * 0.01 * Eigen::Vector3d(10, -20, 30), 1e-9,
                           "w");
  test::expect_near_matrix(imu.samples[2].dv, 0.00333 * 9.80665 * 0.01 * Eigen::Vector3d(1000, -2000, 302), 1e-9, "f");
  EXPECT_EQ(count_of(imu.events, "trailing_garbage"), 1);
}

/// An IMR file as the layout of NovAtel's documentation has it, built field by field.
std::string imr_file(bool increments, double rate, bool utc) {
  std::string b("$IMURAW\0", 8);
  append(b, std::int8_t{0});
  append(b, 8.9);
  append(b, std::int32_t{increments});
  append(b, std::int32_t{increments});
  append(b, rate);
  append(b, 1e-6);  // deg/s, or deg
  append(b, 1e-5);  // m/s^2, or m/s
  append(b, std::int32_t{utc ? 1 : 2});
  append(b, std::int32_t{0});
  append(b, 0.0);
  b.resize(512, '\0');
  for (int i = 0; i < 5; ++i) {
    append(b, 1000.0 + i / rate);
    for (const std::int32_t count : {1000000, -2000000, 3000000, 100000, 200000, -980000}) append(b, count);
  }
  return b;
}

TEST(ImuImr, RatesIncrementsAndUtc) {
  const Files files;
  const double degree = 3.14159265358979 / 180.0;
  files.put("a.imr", imr_file(false, 200.0, false));
  const auto rates = files.imu("a.imr", "gps_week: 2000");
  ASSERT_EQ(rates.samples.size(), 5U);
  test::expect_near_matrix(rates.samples[1].dtheta, degree / 200.0 * Eigen::Vector3d(1.0, -2.0, 3.0), 1e-12, "dtheta");
  test::expect_near_matrix(rates.samples[1].dv, Eigen::Vector3d(1.0, 2.0, -9.8) / 200.0, 1e-12, "dv");
  EXPECT_EQ(rates.samples[1].t, GpsTime::from_week(2000, 1000.005));

  files.put("b.imr", imr_file(true, 200.0, true));
  const auto increments = files.imu("b.imr", "gps_week: 2000");
  test::expect_near_matrix(increments.samples[1].dtheta, degree * Eigen::Vector3d(1.0, -2.0, 3.0), 1e-12, "dtheta");
  // 2018-05-06: 18 leap seconds.
  EXPECT_EQ(increments.samples[1].t, GpsTime::from_week(2000, 1018.005));

  files.put("c.imr", imr_file(true, 0.0, false));
  EXPECT_NE(refusal([&] { (void)files.imu("c.imr", "gps_week: 2000"); }).find("c.imr: header: data rate 0 Hz"),
            std::string::npos);
}

}  // namespace
}  // namespace coast::io
