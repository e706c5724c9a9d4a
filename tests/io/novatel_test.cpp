// NovAtel logs of known content: frames, positions, IMU, trajectory, time marks.

#include <gtest/gtest.h>

#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/contents.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/novatel_messages.hpp"

namespace coast::io {
namespace {

using test::Files;
using test::NovAtelBody;
using test::NovAtelHead;
using test::refusal;

constexpr double kNovAtelDegree = geo::kDegree;

geo::GpsTime novatel_t(double seconds) {
  return geo::GpsTime::from_week(2200, seconds);
}

bool novatel_has_event(const record::Events& events, const std::string& kind, long count) {
  for (const record::Event& event : events)
    if (event.kind == kind && event.count == count) return true;
  return false;
}

// Positions

struct NovAtelPos {
  double lat = 51.15, lon = -114.03, above_sea = 1094.1;
  float undulation = -17.0F;
  std::string type_word = "NARROW_INT";
  unsigned type = 50;
  unsigned status = 0;
};

NovAtelBody bestpos(const NovAtelPos& p) {
  NovAtelBody b;
  b.word(p.status == 0 ? "SOL_COMPUTED" : "INSUFFICIENT_OBS", p.status).word(p.type_word, p.type);
  b.f64(p.lat).f64(p.lon).f64(p.above_sea).f32(p.undulation).word("WGS84", 61);
  b.f32(0.01F).f32(0.02F).f32(0.03F).text("AAAA").f32(1.0F).f32(0.0F);
  return b.u8(20).u8(17).u8(17).u8(16).hex8(0).hex8(6).hex8(0).hex8(0x33);
}

NovAtelBody bestvel(double speed, double course, double up, float latency = 0.0F) {
  return NovAtelBody()
      .word("SOL_COMPUTED", 0)
      .word("NARROW_INT", 50)
      .f32(latency)
      .f32(0.0F)
      .f64(speed)
      .f64(course)
      .f64(up)
      .f32(0.0F);
}

TEST(NovAtelGnss, HasHeightAboveTheEllipsoidAndVelocityInBothForms) {
  const NovAtelHead later{2200, 300'001.0};
  const std::string binary = test::novatel_binary(42, bestpos({})) + test::novatel_binary(99, bestvel(5.0, 30.0, 0.5)) +
                             test::novatel_binary(42, bestpos({}), later);
  const std::string ascii = test::novatel_ascii("BESTPOSA", bestpos({})) +
                            test::novatel_ascii("BESTVELA", bestvel(5.0, 30.0, 0.5)) +
                            test::novatel_ascii("BESTPOSA", bestpos({}), later);
  for (const std::string& content : {binary, ascii}) {
    const Files files;
    GnssFileOptions options;
    options.file = files.put("log.gps", content);
    options.velocity_sd = Eigen::Vector3d(0.1, 0.1, 0.2);
    const auto gnss = read_gnss(options);
    ASSERT_EQ(gnss.fixes.size(), 2U);
    const auto& fix = gnss.fixes[0];
    EXPECT_EQ(fix.t, novatel_t(300'000.0));
    const auto expected = geo::ecef_from_geodetic({51.15 * kNovAtelDegree, -114.03 * kNovAtelDegree, 1077.1});
    EXPECT_LT((fix.r_ea_e - expected).norm(), 1e-5);
    EXPECT_NEAR(fix.position_cov_n(0, 0), 1e-4, 1e-9);
    EXPECT_NEAR(fix.position_cov_n(1, 1), 4e-4, 1e-9);
    EXPECT_NEAR(fix.position_cov_n(2, 2), 9e-4, 1e-9);
    EXPECT_EQ(fix.quality, record::FixQuality::kFixed);
    EXPECT_EQ(fix.satellites, 17);
    ASSERT_TRUE(fix.velocity);
    const Eigen::Vector3d v(5.0 * std::sqrt(0.75), 2.5, -0.5);
    EXPECT_LT((fix.velocity->v_ea_n - v).norm(), 1e-12);
    EXPECT_FALSE(gnss.fixes[1].velocity);
  }
}

TEST(NovAtelGnss, IsThatOfGnssAloneWhereTheFileHasIt) {
  NovAtelPos with_imu;
  with_imu.type = 56;
  with_imu.type_word = "INS_RTKFIXED";
  with_imu.above_sea = 2000.0;
  const Files files;
  GnssFileOptions options;
  options.file = files.put("log.gps", test::novatel_binary(42, bestpos(with_imu)) + test::novatel_binary(1429, bestpos({})));
  auto gnss = read_gnss(options);
  ASSERT_EQ(gnss.fixes.size(), 1U);
  EXPECT_NEAR(geo::geodetic_from_ecef(gnss.fixes[0].r_ea_e).height, 1077.1, 1e-6);
  EXPECT_FALSE(novatel_has_event(gnss.events, "fix_with_imu", 1));
  options.file = files.put("imu.gps", test::novatel_binary(42, bestpos(with_imu)));
  gnss = read_gnss(options);
  EXPECT_TRUE(novatel_has_event(gnss.events, "fix_with_imu", 1));
}

TEST(NovAtelGnss, WithoutSolutionOrFineTimeIsLeftOut) {
  NovAtelPos none;
  none.status = 1;
  const NovAtelHead coarse{2200, 299'000.0, 100, "COARSE"};
  NovAtelPos predicted;
  predicted.type = 19;
  predicted.type_word = "PROPAGATED";
  const Files files;
  GnssFileOptions options;
  options.file =
      files.put("log.gps", test::novatel_binary(42, bestpos({}), coarse) +
                               test::novatel_ascii("BESTPOSA", bestpos({}), coarse) + test::novatel_binary(42, bestpos(none)) +
                               test::novatel_binary(42, bestpos(predicted)) + test::novatel_binary(42, bestpos({})));
  const auto gnss = read_gnss(options);
  EXPECT_EQ(gnss.fixes.size(), 1U);
  EXPECT_TRUE(novatel_has_event(gnss.events, "fix_no_time", 2));
  EXPECT_TRUE(novatel_has_event(gnss.events, "no_solution", 2));
  options.file = files.put("none.gps", test::novatel_binary(101, NovAtelBody().u32(0)));
  EXPECT_NE(refusal([&] { (void)read_gnss(options); }).find("without BESTGNSSPOS, BESTPOS"), std::string::npos);
}

// IMU

NovAtelBody rawimux(double seconds, int type, const std::array<int, 6>& counts) {
  NovAtelBody b;
  b.hex8(4).u8(static_cast<unsigned>(type)).u16(2200).f64(seconds).hex32(0xea59fe00U);
  for (const int count : counts) b.i32(count);
  return b;
}

NovAtelBody rawimu(double seconds, const std::array<int, 6>& counts) {
  NovAtelBody b;
  b.u32(2200).f64(seconds).hex32(0x77);
  for (const int count : counts) b.i32(count);
  return b;
}

constexpr std::array<int, 6> kNovAtelCounts = {1'000'000, -20'000, 3'000, 400, -50, 6};

/// Counts of z, -y, x of accelerometer and gyro, to x, y, z.
void expect_increments(const record::ImuRecording& imu, double gyro, double accel) {
  ASSERT_GE(imu.samples.size(), 3U);
  EXPECT_EQ(imu.samples[0].t, novatel_t(300'000.0));
  EXPECT_NEAR(imu.rate_hz, 100.0, 1e-6);
  const Eigen::Vector3d dv = accel * Eigen::Vector3d(3'000, 20'000, 1'000'000);
  const Eigen::Vector3d dtheta = gyro * Eigen::Vector3d(6, 50, 400);
  EXPECT_LT((imu.samples[1].dv - dv).norm(), 1e-12 * dv.norm());
  EXPECT_LT((imu.samples[1].dtheta - dtheta).norm(), 1e-12 * dtheta.norm());
}

TEST(NovAtelImu, HasTheScaleOfItsTypeAndTheAxesOfTheImu) {
  std::string short_binary, long_binary, ascii, configured;
  configured = test::novatel_binary(1945, NovAtelBody().word("HG4930_AN01", 58).u8(1));
  for (int i = 0; i < 3; ++i) {
    const double t = 300'000.0 + 0.01 * i;
    const NovAtelHead head{2200, t};
    short_binary += test::novatel_short(1462, rawimux(t, 58, kNovAtelCounts), head);
    long_binary += test::novatel_binary(1461, rawimux(t, 58, kNovAtelCounts), head);
    ascii += test::novatel_short_ascii("RAWIMUSXA", rawimux(t, 58, kNovAtelCounts), head);
    configured += test::novatel_short(325, rawimu(t, kNovAtelCounts), head);
  }
  for (const std::string& content : {short_binary, long_binary, ascii, configured}) {
    const Files files;
    ImuFileOptions options;
    options.file = files.put("log.gps", content);
    expect_increments(read_imu(options), std::ldexp(1.0, -33), std::ldexp(1.0, -29));
  }
}

/// One sample of a RAWIMUSX in the manual, of an Epson G320N at rest: its CRC, and gravity.
TEST(NovAtelImu, OfTheManualMeasuresGravity) {
  const std::string line =
      "%RAWIMUSXA,2209,491674.014;04,41,2209,491674.013699,ea59fe00,329308016,-2706935,4508389,196192,417138,-1000837*"
      "038422a7\r\n";
  const NovAtelHead next{2209, 491'674.022};
  NovAtelBody second;
  second.hex8(4).u8(41).u16(2209).f64(491'674.021699).hex32(0xea59fe00U);
  for (const int count : {329308016, -2706935, 4508389, 196192, 417138, -1000837}) second.i32(count);
  const Files files;
  ImuFileOptions options;
  options.file = files.put("log.asc", line + test::novatel_short_ascii("RAWIMUSXA", second, next));
  const auto imu = read_imu(options);
  ASSERT_EQ(imu.samples.size(), 2U);
  EXPECT_EQ(imu.samples[0].t, geo::GpsTime::from_week(2209, 491'674.013699));
  EXPECT_NEAR(imu.samples[1].dv.norm() / 0.008, 9.81, 0.1);
}

TEST(NovAtelImu, OfAnUnknownTypeNeedsItsScale) {
  std::string content;
  for (int i = 0; i < 3; ++i) {
    const double t = 300'000.0 + 0.01 * i;
    content += test::novatel_short(325, rawimu(t, kNovAtelCounts), {2200, t});
  }
  const Files files;
  ImuFileOptions options;
  options.file = files.put("log.gps", content);
  const std::string found = refusal([&] { (void)read_imu(options); });
  EXPECT_NE(found.find("counts of an IMU whose type no log states"), std::string::npos) << found;
  EXPECT_NE(found.find("values: increments"), std::string::npos);
  options.increments = true;
  options.gyro_to_si = 1e-9;
  options.accel_to_si = 2e-8;
  expect_increments(read_imu(options), 1e-9, 2e-8);
}

TEST(NovAtelImu, WithoutGravityIsRefused) {
  std::string content;
  for (int i = 0; i < 3; ++i) {
    const double t = 300'000.0 + 0.01 * i;
    NovAtelBody b;
    b.u32(2200).f64(t);
    for (int k = 0; k < 6; ++k) b.f64(1e-6);
    content += test::novatel_short(813, b, {2200, t});
  }
  const Files files;
  ImuFileOptions options;
  options.file = files.put("log.gps", content);
  const std::string found = refusal([&] { (void)read_imu(options); });
  EXPECT_NE(found.find("3 logs of CORRIMUDATA"), std::string::npos) << found;
}

// Trajectory

NovAtelBody inspva(double seconds, const std::string& status_word = "INS_SOLUTION_GOOD", unsigned status = 3) {
  NovAtelBody b;
  b.u32(2200).f64(seconds).f64(51.15).f64(-114.03).f64(1077.1).f64(1.0).f64(2.0).f64(0.5);
  return b.f64(0.0).f64(10.0).f64(90.0).word(status_word, status);
}

TEST(NovAtelTrajectory, HasAttitudeOfForwardRightDown) {
  NovAtelBody extended;
  extended.word("INS_SOLUTION_GOOD", 3).word("INS_RTKFIXED", 56).f64(51.15).f64(-114.03).f64(1094.1).f32(-17.0F);
  extended.f64(1.0).f64(2.0).f64(0.5).f64(0.0).f64(10.0).f64(90.0);
  for (int i = 0; i < 9; ++i) extended.f32(0.1F);
  extended.hex32(0x3U).u16(0);
  const std::string one = test::novatel_short(508, inspva(300'000.0, "INS_ALIGNING", 1)) +
                          test::novatel_short(508, inspva(300'000.1)) + test::novatel_short(508, inspva(300'000.2));
  const std::string two = test::novatel_short_ascii("INSPVASA", inspva(300'000.0, "INS_ALIGNING", 1)) +
                          test::novatel_ascii("INSPVAA", inspva(300'000.1)) +
                          test::novatel_short_ascii("INSPVASA", inspva(300'000.2));
  const std::string three = test::novatel_binary(1465, extended, {2200, 300'000.1});
  const std::string four = test::novatel_ascii("INSPVAXA", extended, {2200, 300'000.1});
  for (const std::string& content : {one, two, three, four}) {
    const Files files;
    const auto trajectory = read_reference(ReferenceFileOptions::of_file(files.put("log.gps", content)));
    ASSERT_GE(trajectory.states.size(), 1U);
    const auto& state = trajectory.states.front();
    const geo::Geodetic p{51.15 * kNovAtelDegree, -114.03 * kNovAtelDegree, 1077.1};
    EXPECT_LT((state.r_eb_e - geo::ecef_from_geodetic(p)).norm(), 1e-5);
    const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
    EXPECT_LT((C_n_e.transpose() * state.v_eb_e - Eigen::Vector3d(1.0, 2.0, -0.5)).norm(), 1e-9);
    // Azimuth 90 deg, nose up by 10 deg: forward is east and up, right is south.
    const Eigen::Matrix3d C_b_n = C_n_e.transpose() * state.q_b_e.toRotationMatrix();
    const double c = std::cos(10.0 * kNovAtelDegree), s = std::sin(10.0 * kNovAtelDegree);
    EXPECT_LT((C_b_n.col(0) - Eigen::Vector3d(0.0, c, -s)).norm(), 1e-12);
    EXPECT_LT((C_b_n.col(1) - Eigen::Vector3d(-1.0, 0.0, 0.0)).norm(), 1e-12);
  }
  const Files files;
  const auto trajectory = read_reference(ReferenceFileOptions::of_file(files.put("log.gps", one)));
  EXPECT_EQ(trajectory.states.front().t, novatel_t(300'000.1));
  EXPECT_TRUE(novatel_has_event(trajectory.events, "ins_not_aligned", 1));
}

// Time marks

TEST(NovAtelTimeMarks, HaveTheirInputAndTheTimeOfTheBody) {
  const auto mark = [](double seconds, unsigned status) {
    const char* word = status == 0 ? "VALID" : "INVALID";
    return NovAtelBody().i32(2200).f64(seconds).f64(1e-8).f64(2e-8).f64(-18.0).word(word, status);
  };
  const std::string content =
      test::novatel_binary(231, mark(300'000.123456789, 0)) + test::novatel_ascii("MARK2TIMEA", mark(299'999.5, 0)) +
      test::novatel_binary(616, mark(299'999.6, 3)) + test::novatel_binary(1067, inspva(300'000.123456789)) +
      test::novatel_binary(1118, inspva(300'001.0));
  const Files files;
  const auto marks = read_time_marks(TimeMarkFileOptions::of_file(files.put("log.gps", content)));
  ASSERT_EQ(marks.marks.size(), 3U);
  EXPECT_EQ(marks.marks[0].channel, 2);
  EXPECT_EQ(marks.marks[1].channel, 1);
  EXPECT_EQ(marks.marks[1].t, novatel_t(300'000.123456789));
  EXPECT_EQ(marks.marks[1].sd_s, 2e-8);
  EXPECT_EQ(marks.marks[2].channel, 3);
  EXPECT_TRUE(novatel_has_event(marks.events, "time_mark_invalid", 1));
}

// Frames

TEST(NovAtelMessages, OfAllFormsAreFoundBetweenGarbageAndCounted) {
  std::string wrong = test::novatel_binary(42, bestpos({}), {2200, 300'003.0});
  wrong[40] = static_cast<char>(~wrong[40]);
  std::string wrong_text = test::novatel_ascii("BESTPOSA", bestpos({}), {2200, 300'004.0});
  wrong_text[60] = wrong_text[60] == '1' ? '2' : '1';
  const std::string content =
      test::novatel_binary(42, bestpos({})) + "\xaa\x44\x12 no frame #BEST %" + test::nmea("GPGGA,1,2,3") +
      test::novatel_ascii("BESTPOSA", bestpos({}), {2200, 300'001.0}) + wrong + wrong_text + test::rtcm3(1005, 19) +
      test::novatel_ascii("VERSIONA", NovAtelBody().u32(0)) + test::novatel_binary(42, bestpos({}), {2200, 300'002.0}) +
      test::novatel_binary(42, bestpos({}), {2200, 300'005.0}).substr(0, 60);
  const Files files;
  const auto file = files.put("log.gps", content);
  const auto contents = read_contents(file);
  EXPECT_EQ(contents.format, "logs of NovAtel receivers");
  std::map<std::string, long> messages;
  for (const MessageCount& count : contents.messages) messages[count.name] = count.number;
  const std::map<std::string, long> expected = {
      {"NovAtel BESTPOS", 2}, {"NovAtel ASCII BESTPOS", 1}, {"NovAtel ASCII VERSION", 1}, {"NMEA GGA", 1}, {"RTCM 1005", 1}};
  EXPECT_EQ(messages, expected);
  ASSERT_TRUE(contents.gnss);
  EXPECT_EQ(contents.gnss->fixes.size(), 3U);
  const auto of_kind = [&](const std::string& kind) {
    return std::ranges::count(contents.gnss->events, kind, &record::Event::kind);
  };
  EXPECT_EQ(of_kind("message_checksum"), 2);  // binary and ASCII
  EXPECT_EQ(of_kind("message_garbage"), 1);
  EXPECT_EQ(of_kind("message_cut_off"), 1);
  EXPECT_EQ(of_kind("messages_not_read"), 1);
}

}  // namespace
}  // namespace coast::io
