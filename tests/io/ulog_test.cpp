// ULog files of known content, and a recorded one against another reader.

#include <gtest/gtest.h>

#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/receiver_messages.hpp"

namespace coast::io {
namespace {

using test::Bytes;
using test::Files;
using test::refusal;

std::string ulog_message(char type, const std::string& content) {
  return Bytes().u2(static_cast<unsigned>(content.size())).u1(static_cast<unsigned char>(type)).text(content).str();
}

std::string ulog_head() {
  return Bytes().text("ULog").u1(1).u1(0x12).u1(0x35).u1(1).put<std::uint64_t>(5).str();
}

std::string ulog_flags(unsigned incompatible = 0, std::uint64_t appended = 0) {
  return ulog_message('B', Bytes().zeros(8).u1(incompatible).zeros(7).put<std::uint64_t>(appended).zeros(16).str());
}

std::string subscription(unsigned id, unsigned instance, const std::string& topic) {
  return ulog_message('A', Bytes().u1(instance).u2(id).text(topic).str());
}

std::string logged(unsigned id, const Bytes& fields) {
  return ulog_message('D', Bytes().u2(id).text(fields.str()).str());
}

const std::string kUlogSyncMessage =
    ulog_message('S', Bytes().u1(0x2f).u1(0x73).u1(0x13).u1(0x20).u1(0x25).u1(0x0c).u1(0xbb).u1(0x12).str());

/// A nested format in front, so that places follow from its size.
const std::string kUlogDefinitions =
    ulog_flags() + ulog_message('F', "inner:uint16_t a;float[2] b;") +
    ulog_message('F',
                 "sensor_combined:uint64_t timestamp;inner nested;float[3] gyro_rad;uint32_t gyro_integral_dt;float[3] "
                 "accelerometer_m_s2;uint8_t[4] _padding0;") +
    ulog_message(
        'F',
        "vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t alt_ellipsoid;float "
        "s_variance_m_s;float eph;float epv;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;int32_t "
        "timestamp_time_relative;uint8_t fix_type;bool vel_ned_valid;uint8_t satellites_used;") +
    ulog_message('I', "xx") + subscription(3, 0, "sensor_combined") + subscription(4, 0, "vehicle_gps_position") +
    subscription(9, 1, "sensor_combined");

constexpr std::int64_t kUlogUtc = 1'700'000'000'000'000;  // us; 2023-11-14 22:13:20 UTC
const geo::GpsTime kUlogStart = geo::GpsTime::from_utc({2023, 11, 14, 22, 13, 20.0});

std::string combined(unsigned id, std::uint64_t boot_us, float value) {
  Bytes b;
  b.put<std::uint64_t>(boot_us).u2(7).r4(1.0F).r4(2.0F).r4(value).r4(0.5F).r4(-0.25F).u4(5000);
  b.r4(0.125F).r4(-0.5F).r4(-9.75F);
  return logged(id, b);
}

struct UlogGps {
  std::int64_t boot_us = 10'000'000;
  std::int64_t utc_us = kUlogUtc;
  int relative = -100'000;
  unsigned fix = 3, valid = 1;
  float eph = 1.5F, epv = 2.0F, speed = 0.3F;
  int lat = 473'977'420;
};

std::string gps_position(const UlogGps& g) {
  Bytes b;
  b.put<std::uint64_t>(static_cast<std::uint64_t>(g.boot_us)).put<std::uint64_t>(static_cast<std::uint64_t>(g.utc_us));
  b.i4(g.lat).i4(85'455'940).i4(512'345).r4(g.speed).r4(g.eph).r4(g.epv).r4(1.0F).r4(-2.0F).r4(0.5F).i4(g.relative);
  b.u1(g.fix).u1(g.valid).u1(14);
  return logged(4, b);
}

/// IMU at 200 Hz and positions at 5 Hz for some seconds.
std::string flight(int seconds) {
  std::string content;
  for (int i = 0; i < 200 * seconds; ++i) {
    content += combined(3, 10'000'000U + 5000U * static_cast<unsigned>(i), static_cast<float>(i));
    if (i % 40 != 0) continue;
    UlogGps g;
    g.boot_us += 5000 * i + 100'000;
    g.utc_us += 5000 * i;
    content += gps_position(g);
  }
  return content;
}

TEST(UlogImu, HasItsNumbersInGpsTime) {
  const Files files;
  files.put_gzip("flight.ulg.gz", ulog_head() + kUlogDefinitions + flight(4));
  const auto recording = files.imu("flight.ulg.gz");
  ASSERT_EQ(recording.samples.size(), 800U);
  EXPECT_NEAR(recording.rate_hz, 200.0, 1e-9);
  const record::ImuSample& s = recording.samples[100];
  EXPECT_NEAR(s.t - (kUlogStart + 0.5), 0.0, 2e-9);
  EXPECT_LT((s.dtheta / s.dt - Eigen::Vector3d(100.0, 0.5, -0.25)).norm(), 1e-9);
  EXPECT_LT((s.dv / s.dt - Eigen::Vector3d(0.125, -0.5, -9.75)).norm(), 1e-12);
  EXPECT_EQ(test::count_of(recording.events, "imu_clock_tied"), 1);
}

TEST(UlogImu, TakesTheClocksDriftFromALongFlight) {
  // The autopilot's clock gains 50 ppm: its microseconds are shorter.
  const Files files;
  std::string content = ulog_head() + kUlogDefinitions;
  for (int i = 0; i < 1200; ++i) {
    const auto boot = 10'000'000U + 100'005U * static_cast<unsigned>(i);
    content += combined(3, boot, 0.0F);
    UlogGps g;
    g.boot_us = boot;
    g.relative = 0;
    g.utc_us += 100'000LL * i;
    if (i == 600) g.utc_us -= 2'000'000;  // one that is late by 2 s does not move the line
    content += gps_position(g);
  }
  files.put("flight.ulg", content);
  const auto recording = files.imu("flight.ulg");
  EXPECT_NEAR(recording.samples.back().t - recording.samples.front().t, 119.9, 1e-4);
}

TEST(UlogImu, PairsGyroAndAccelerometerWhereTheyHaveMore) {
  std::string content =
      ulog_head() + kUlogDefinitions +
      ulog_message('F', "sensor_gyro:uint64_t timestamp;uint64_t timestamp_sample;float x;float y;float z;") +
      ulog_message('F', "sensor_accel:uint64_t timestamp;uint64_t timestamp_sample;float x;float y;float z;") +
      subscription(20, 0, "sensor_gyro") + subscription(21, 0, "sensor_accel") + subscription(22, 1, "sensor_gyro");
  for (int i = 0; i < 1000; ++i) {
    const auto us = 10'000'000U + 2500U * static_cast<unsigned>(i);
    const auto put = [&](unsigned id, unsigned at, float x) {
      Bytes b;
      b.put<std::uint64_t>(at + 300U).put<std::uint64_t>(at).r4(x).r4(0.5F).r4(-0.25F);
      content += logged(id, b);
    };
    put(20, us, static_cast<float>(i));
    put(22, us, -1.0F);
    put(21, us + 1000U, static_cast<float>(i));
  }
  content += flight(2);
  const Files files;
  files.put("flight.ulg", content);
  const auto recording = files.imu("flight.ulg");
  ASSERT_EQ(recording.samples.size(), 999U);
  EXPECT_NEAR(recording.rate_hz, 400.0, 1e-6);
  const record::ImuSample& s = recording.samples[9];  // of gyro 10: the first is before any specific force
  EXPECT_NEAR(s.dtheta.x() / s.dt, 10.0, 1e-9);
  EXPECT_NEAR(s.dv.x() / s.dt, 9.0 + 0.6, 1e-6);  // 1.5 of 2.5 ms after the one before
}

TEST(UlogGnss, HasItsFixes) {
  const Files files;
  UlogGps bad_fix, no_time, no_accuracy, no_velocity;
  bad_fix.boot_us += 200'000;
  bad_fix.utc_us += 200'000;
  bad_fix.fix = 2;
  no_time.utc_us = 0;
  no_accuracy.utc_us += 400'000;
  no_accuracy.eph = 0.0F;
  no_velocity.utc_us += 600'345;
  no_velocity.valid = 0;
  no_velocity.fix = 6;
  files.put("flight.ulg", ulog_head() + kUlogDefinitions + gps_position({}) + gps_position(bad_fix) + gps_position(no_time) +
                              gps_position(no_accuracy) + gps_position(no_velocity));
  const auto recording = files.gnss("flight.ulg");
  ASSERT_EQ(recording.fixes.size(), 2U);
  const record::GnssFix& fix = recording.fixes[0];
  EXPECT_EQ(fix.t, kUlogStart);
  const geo::Geodetic place{47.397742 * geo::kDegree, 8.545594 * geo::kDegree, 512.345};
  EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic(place)).norm(), 1e-6);
  EXPECT_LT((fix.position_cov_n.diagonal() - Eigen::Vector3d(1.125, 1.125, 4.0)).norm(), 1e-12);
  EXPECT_EQ(fix.velocity->v_ea_n, Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_NEAR(fix.velocity->cov_n.trace(), 0.09, 1e-7);
  EXPECT_EQ(fix.quality, record::FixQuality::kSingle);
  EXPECT_EQ(fix.satellites, 14);
  EXPECT_EQ(recording.fixes[1].quality, record::FixQuality::kFixed);
  EXPECT_EQ(recording.fixes[1].t.nanoseconds(), kUlogStart.nanoseconds() + 600'345'000);
  EXPECT_FALSE(recording.fixes[1].velocity);
  EXPECT_FALSE(files.gnss("flight.ulg", "velocity_sd_mps: [1, 1, 1]").fixes[1].velocity);  // none is stated
  for (const char* kind : {"no_solution", "fix_no_time", "fix_no_accuracy"})
    EXPECT_EQ(test::count_of(recording.events, kind), 1) << kind;
  EXPECT_EQ(files.gnss("flight.ulg", "sd_m: [1, 1, 1]").fixes.size(), 3U);
}

TEST(UlogGnss, OfSensorGpsWithItsNewNamesIsRead) {
  std::string content = ulog_head() + ulog_flags() +
                        ulog_message('F',
                                     "sensor_gps:uint64_t timestamp;uint64_t time_utc_usec;double latitude_deg;double "
                                     "longitude_deg;double altitude_ellipsoid_m;float eph;float epv;uint8_t fix_type;") +
                        subscription(1, 0, "sensor_gps") + subscription(2, 1, "sensor_gps");
  for (const unsigned id : {2U, 1U}) {
    Bytes b;
    b.put<std::uint64_t>(100).put<std::uint64_t>(static_cast<std::uint64_t>(kUlogUtc)).r8(47.5 + id).r8(8.5).r8(500.25);
    content += logged(id, b.r4(1.0F).r4(1.0F).u1(5));
  }
  const Files files;
  files.put("flight.ulg", content);
  const auto fixes = files.gnss("flight.ulg").fixes;
  ASSERT_EQ(fixes.size(), 1U);
  EXPECT_LT((fixes[0].r_ea_e - geo::ecef_from_geodetic({48.5 * geo::kDegree, 8.5 * geo::kDegree, 500.25})).norm(), 1e-6);
  EXPECT_EQ(fixes[0].quality, record::FixQuality::kFloat);
}

TEST(UlogFile, GoesOnAfterDamageAtTheNextSync) {
  const std::string start = ulog_head() + kUlogDefinitions + flight(3);
  const Files files;
  files.put("flight.ulg", start + std::string(50, '\xff') + ulog_message('O', Bytes().u2(250).str()) + kUlogSyncMessage +
                              combined(3, 13'500'000, 1.0F) + combined(9, 13'600'000, 9.0F) + combined(77, 13'600'000, 9.0F) +
                              logged(3, Bytes().zeros(60)) + ulog_message('O', Bytes().u2(120).str()) +
                              combined(3, 13'700'000, 1.0F).substr(0, 30));
  const auto recording = files.imu("flight.ulg");
  EXPECT_EQ(recording.samples.size(), 601U);
  // The message in the garbage is lost with it; the byte 0xff is no type, so that all up to the sync message is skipped.
  EXPECT_EQ(test::count_of(recording.events, "message_garbage"), 55);
  EXPECT_EQ(test::count_of(recording.events, "log_dropout"), 1);
  EXPECT_EQ(test::count_of(recording.events, "log_undefined"), 2);  // an unknown topic, and one of another size
  EXPECT_EQ(test::count_of(recording.events, "message_cut_off"), 1);
}

TEST(UlogFile, WithDataAppendedAfterACrashIsReadOn) {
  const std::string cut = combined(3, 1, 1.0F).substr(0, 20);
  // Flags come first, and have a fixed length: the position of what is appended follows.
  const std::size_t flags = ulog_flags().size();
  const std::string before = kUlogDefinitions.substr(flags) + flight(3);
  const std::uint64_t at = ulog_head().size() + flags + before.size() + cut.size();
  const Files files;
  files.put("flight.ulg", ulog_head() + ulog_flags(1, at) + before + cut + combined(3, 13'000'000, 1.0F));
  EXPECT_EQ(files.imu("flight.ulg").samples.size(), 601U);
}

TEST(UlogFile, ThatCannotBeReadIsRefused) {
  const Files files;
  const auto imu = [&](const std::string& content) {
    files.put("flight.ulg", content);
    return refusal([&] { (void)files.imu("flight.ulg", "format: ulog"); });
  };
  EXPECT_NE(imu("ULag").find("no \"ULog\""), std::string::npos);
  EXPECT_NE(imu(ulog_head().substr(0, 10)).find("the header is cut off"), std::string::npos);
  std::string late = ulog_head();
  late[7] = 9;
  EXPECT_NE(imu(late).find("version 9"), std::string::npos);
  EXPECT_NE(imu(ulog_head() + ulog_flags(2)).find("flags of a feature"), std::string::npos);
  EXPECT_NE(imu(ulog_head() + kUlogDefinitions).find("0 IMU samples"), std::string::npos);
  std::string without = ulog_head() + kUlogDefinitions;
  for (unsigned i = 0; i < 20; ++i) without += combined(3, 5000U * i, 0.0F);
  EXPECT_NE(imu(without).find("fewer than ten GNSS messages with UTC"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.gnss("flight.ulg"); }).find("a flight log without positions"), std::string::npos);
}

TEST(UlogFile, WithWrongDefinitionsLosesOnlyTheirTopics) {
  const std::vector<std::string> wrong = {":float x;",
                                          "name",
                                          "a:float;",
                                          "a:float[ x;",
                                          "a:float[0] x;",
                                          "a:float[9 x;",
                                          "a:[3] x;",
                                          "a:",
                                          "sensor_gyro:sensor_gyro me;float x;",
                                          "sensor_gyro:unknown y;float x;"};
  std::string content = ulog_head() + kUlogDefinitions;
  for (const std::string& definition : wrong) content += ulog_message('F', definition) + subscription(30, 0, "sensor_gyro");
  content += ulog_message('A', "x") + flight(3) + logged(30, Bytes().r4(1.0F)) + ulog_message('R', Bytes().u2(9).str());
  const Files files;
  files.put("flight.ulg", content);
  EXPECT_EQ(files.imu("flight.ulg").samples.size(), 600U);
}

TEST(UlogRecording, HasTheNumbersOfAnotherReader) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  const auto file = *test::data_dir() / "ulog-px4/sample_log_small.ulg";
  const auto lines = test::lines_of_script("ulog_table.py", file);
  if (lines.empty()) GTEST_SKIP() << "no python3 with numpy here";
  ImuFileOptions imu_options;
  imu_options.file = file;
  GnssFileOptions gnss_options;
  gnss_options.file = file;
  const auto imu = read_imu(imu_options);
  const auto gnss = read_gnss(gnss_options);
  std::size_t samples = 0, fixes = 0;
  std::int64_t last_boot = 0;
  double mean_offset = 0.0;  // of GPS time and the autopilot's, from the first sample's
  for (const std::string& line : lines) {
    std::istringstream fields(line);
    std::string kind;
    fields >> kind;
    if (kind == "imu") {
      std::int64_t boot = 0;
      Eigen::Vector3d gyro, accel;
      fields >> boot >> gyro.x() >> gyro.y() >> gyro.z() >> accel.x() >> accel.y() >> accel.z();
      ASSERT_LT(samples, imu.samples.size());
      const record::ImuSample& s = imu.samples[samples];
      const geo::GpsTime before = samples > 0 ? imu.samples[samples - 1].t : s.t;
      EXPECT_NEAR(s.t - before, samples > 0 ? 1e-6 * static_cast<double>(boot - last_boot) : 0.0, 2e-9);
      if (s.dt < 0.007) {  // else after a gap, and bridged
        EXPECT_LT((s.dtheta / s.dt - gyro).norm(), 1e-9);
        EXPECT_LT((s.dv / s.dt - accel).norm(), 1e-8);
      }
      last_boot = boot;
      ++samples;
    } else {
      std::int64_t boot = 0, utc = 0;
      double lat = 0, lon = 0, height = 0, eph = 0, epv = 0, speed = 0;
      Eigen::Vector3d v;
      int fix = 0, satellites = 0;
      fields >> boot >> utc >> lat >> lon >> height >> eph >> epv >> v.x() >> v.y() >> v.z() >> speed >> fix >> satellites;
      ASSERT_LT(fixes, gnss.fixes.size());
      const record::GnssFix& f = gnss.fixes[fixes++];
      EXPECT_EQ(f.t.nanoseconds() - geo::GpsTime::from_unix_utc(1'618'986'650.0).nanoseconds(),
                1000 * (utc - 1'618'986'650'000'000));
      const geo::Geodetic place{1e-7 * lat * geo::kDegree, 1e-7 * lon * geo::kDegree, 1e-3 * height};
      EXPECT_LT((f.r_ea_e - geo::ecef_from_geodetic(place)).norm(), 1e-6);
      EXPECT_LT((f.velocity->v_ea_n - v).norm(), 1e-9);
      EXPECT_NEAR(f.position_cov_n(0, 0), 0.5 * eph * eph, 1e-9);
      EXPECT_NEAR(f.position_cov_n(2, 2), epv * epv, 1e-9);
      EXPECT_NEAR(f.velocity->cov_n.trace(), speed * speed, 1e-9);
      EXPECT_EQ(f.quality, record::FixQuality::kSingle);
      EXPECT_EQ(f.satellites, satellites);
      mean_offset += f.t - imu.samples.back().t - 1e-6 * static_cast<double>(boot - last_boot);
    }
  }
  EXPECT_EQ(samples, imu.samples.size());
  EXPECT_EQ(samples, 1298U);
  EXPECT_EQ(fixes, gnss.fixes.size());
  EXPECT_EQ(fixes, 32U);
  // The line goes through the middle of the messages' arrivals, which scatter by some milliseconds.
  EXPECT_LT(std::abs(mean_offset / static_cast<double>(fixes)), 2e-3);
  EXPECT_EQ(test::count_of(imu.events, "log_dropout"), 1);
}

}  // namespace
}  // namespace coast::io
