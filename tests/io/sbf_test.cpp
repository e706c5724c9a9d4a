// SBF files of known content, put together field by field.

#include <gtest/gtest.h>

#include <cstdlib>

#include "../../src/io/frames/frame_stream.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/rinex.hpp"
#include "coast/io/time_marks.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/sbf_messages.hpp"

namespace coast::io {
namespace {

using test::ext_event;
using test::ext_sensor_meas;
using test::Files;
using test::kSbfTestTow;
using test::kSbfTestWeek;
using test::kSbfUnknown;
using test::meas_epoch;
using test::refusal;
using test::sbf;
using test::sbf_covariance;
using test::sbf_pvt;
using test::SbfPvt;
using test::SbfSatelliteSent;
using test::SbfSignalSent;

const geo::GpsTime kSbfStart = geo::GpsTime::from_week(kSbfTestWeek, 1e-3 * kSbfTestTow);
constexpr double kL1 = 1575.42e6, kL2 = 1227.60e6, kE5b = 1207.14e6;

record::ObservationRecording sbf_observations_of(const std::string& content) {
  const Files files;
  return read_observations(files.put("rover.sbf", content));
}

std::string sbf_signals_of(const record::ObservationEpoch& epoch) {
  std::string text;
  for (const record::Observation& o : epoch.observations)
    text += record::to_string(o.satellite) + o.signal.band + o.signal.tracking + " ";
  return text;
}

/// GPS with three signals, whose phases and Dopplers are those of one range.
SbfSatelliteSent gps_satellite() {
  SbfSignalSent l1, p2, l2;
  p2 = {2, kL2, 21'000'004.5, 85'990'000.125, -1234.5 * kL2 / kL1 + 1.25, 38.75, 900, false, 0};
  l2 = {3, kL2, 20'999'990.0, 85'995'001.375, -1234.5 * kL2 / kL1 - 2.5, 41.5, 12, true, 0};
  return {5, {l1, p2, l2}, 0};
}

struct SbfSeen {
  std::vector<std::string> names;
  FrameCensus census;
};

SbfSeen sbf_frames_of(const std::string& content) {
  const Files files;
  FrameStream stream(files.put("log.sbf", content), kSbfLog);
  SbfSeen seen;
  MessageFrame frame;
  while (stream.next(frame)) seen.names.push_back(frame_name(frame.protocol, frame.id));
  seen.census = stream.census();
  return seen;
}

TEST(SbfFrames, AreToldFromNmeaThatBeginsWithTheSameByte) {
  const std::string block = sbf(4027, std::string(1000, '$')), reply = "$R: sso, Stream1\r\n";
  const SbfSeen seen = sbf_frames_of(test::nmea("GPGGA,,,,,,0") + block + reply + test::nmea("GPGGA,,,,,,0") +
                                     sbf(4242, "$@$@$GP", kSbfTestTow, kSbfTestWeek, 7) + test::rtcm3(1005, 19));
  EXPECT_EQ(seen.names, (std::vector<std::string>{"NMEA GGA", "SBF MeasEpoch", "NMEA GGA", "SBF BDSRawB2b", "RTCM 1005"}));
  EXPECT_EQ(seen.census.skipped, reply.size());
  EXPECT_EQ(frame_name(Protocol::kSbf, 4999), "SBF 4999");
}

TEST(SbfFrames, WithAWrongByteOrCutAreLeftOutAndCounted) {
  const std::string one = sbf(4007, std::string(86, 'x'));
  for (std::size_t at = 0; at < one.size(); ++at) {
    std::string spoiled = one;
    spoiled[at] = static_cast<char>(spoiled[at] ^ 0x11);
    const SbfSeen seen = sbf_frames_of(one + spoiled + one);
    ASSERT_EQ(seen.names.size(), 2U) << at;
    EXPECT_EQ(seen.census.skipped, one.size()) << at;
    const SbfSeen cut = sbf_frames_of(one + one.substr(0, at));
    ASSERT_EQ(cut.names.size(), 1U) << at;
    EXPECT_EQ(cut.census.cut_off, at);
  }
}

TEST(SbfObservations, HaveTheirNumbers) {
  SbfSignalSent r1, r2;
  const double kChannel = -4.0, f1 = 1602e6 + 562.5e3 * kChannel, f2 = 1246e6 + 437.5e3 * kChannel;
  r1 = {8, f1, 64'000'000.001, 342'000'000.0, 3210.9876, 33.0, 5, false, 0};
  r1.phase = 64'000'000.001 * f1 / 299'792'458.0 - 8'000.0;  // nearly as far from the code as the field allows
  r2 = {11, f2, 64'000'120.5, 0.0, 3210.9876 * f2 / f1, 30.0, 5, false, 0};
  r2.phase = 64'000'120.5 * f2 / 299'792'458.0 + 8'000.0;
  const SbfSatelliteSent glonass{39, {r1, r2}, 4};
  for (const std::size_t extra : {std::size_t{0}, std::size_t{8}}) {
    const auto recording = sbf_observations_of(meas_epoch({glonass, gps_satellite()}, kSbfTestTow, 0, kSbfTestWeek, extra));
    ASSERT_EQ(recording.epochs.size(), 1U);
    EXPECT_EQ(recording.epochs[0].t, kSbfStart);
    ASSERT_EQ(sbf_signals_of(recording.epochs[0]), "G051C G052L G052W R021C R022C ");
    EXPECT_EQ(recording.glonass_channels, (std::map<int, int>{{2, -4}}));
    const auto g = gps_satellite();
    const std::vector<std::pair<std::size_t, SbfSignalSent>> sent = {
        {0, g.signals[0]}, {1, g.signals[2]}, {2, g.signals[1]}, {3, r1}, {4, r2}};
    for (const auto& [i, s] : sent) {
      const record::Observation& o = recording.epochs[0].observations[i];
      EXPECT_NEAR(o.code_m.value(), s.code, 0.51e-3);
      EXPECT_NEAR(o.phase_cycles.value(), s.phase, 0.51e-3);
      EXPECT_NEAR(o.doppler_hz.value(), s.doppler, 1.1e-4);
      EXPECT_EQ(o.cn0_dbhz.value(), s.cn0);
      EXPECT_EQ(o.half_cycle, s.half_cycle);
      EXPECT_TRUE(o.lost_lock);  // the first epoch
    }
  }
}

TEST(SbfObservations, HaveTheNamesOfAllSignalsAndSatellites) {
  const std::vector<std::pair<SbfSatelliteSent, std::string>> all = {
      {{1, {{0}, {1}, {2}, {3}, {4}, {5}}}, "G011C G011L G011W G012L G012W G015Q "},
      {{38, {{8}, {9}, {10}, {11}, {12}}, 8}, "R011C R011P R012C R012P R013Q "},
      {{63, {{8}}, 14}, "R251C "},
      {{71, {{17}, {19}, {20}, {21}, {22}}}, "E011C E015Q E016C E017Q E018Q "},
      {{120, {{24}, {25}}}, "S201C S205I "},
      {{198, {{24}}}, "S411C "},
      {{215, {{24}}}, "S581C "},
      {{141, {{13}, {14}, {28}, {29}, {30}, {34}}}, "C011P C012I C015P C016I C017D C017I "},
      {{180, {{28}}}, "C402I "},
      {{223, {{28}}}, "C412I "},
      {{245, {{28}}}, "C632I "},
      {{181, {{6}, {7}, {26}, {32}, {33}, {38}, {39}}}, "J011C J011E J011L J011Z J012L J015P J015Q "},
      {{191, {{15}}}, "I015A "},
      {{216, {{15}}}, "I085A "}};
  for (const auto& [satellite, names] : all) {
    const auto recording = sbf_observations_of(meas_epoch({satellite}));
    EXPECT_EQ(sbf_signals_of(recording.epochs.at(0)), names);
  }
  const auto e6b = sbf_observations_of(meas_epoch({{71, {{17}, {19}}, 0}}, kSbfTestTow, 0x40));
  EXPECT_EQ(sbf_signals_of(e6b.epochs.at(0)), "E011C E016B ");
  // An unknown slot, a reserved ID, an L-band satellite, a reserved signal, a signal of another system, an undefined one.
  const auto unknown = sbf_observations_of(
      meas_epoch({{62, {{8}}, 8}, {69, {{0}}}, {107, {{23}}}, {7, {{0}, {16}, {17}, {45}}}, {8, {{17}, {0}}}}));
  EXPECT_EQ(sbf_signals_of(unknown.epochs.at(0)), "G071C ");
  EXPECT_EQ(test::count_of(unknown.events, "sbf_unknown_signal"), 8);
}

TEST(SbfObservations, LeaveOutWhatTheReceiverDoesNotKnow) {
  const auto block = [](const std::string& channels, unsigned masters) {
    return sbf(4027, test::Bytes().u1(masters).u1(20).u1(12).u1(0).u1(0).u1(0).text(channels).str());
  };
  test::Bytes b;
  // No code: neither is there a phase, which is relative to it, nor a code of the other signal.
  b.u1(1).u1(0).u1(5).u1(0).u4(0).i4(1000).u2(5).i1(0).u1(100).u2(7).u1(0).u1(1);
  b.u1(3).u1(7).u1(100).u1(0).i1(0).u1(0).u2(1).u2(1).u2(1);
  // No phase by its value, no Doppler, no C/N0; the slave without phase, by its lock time, and without Doppler.
  b.u1(1).u1(0).u1(6).u1(4).u4(0).i4(INT32_MIN).u2(0).i1(-128).u1(255).u2(7).u1(4).u1(1);
  b.u1(3).u1(255).u1(100).u1(16U << 3).i1(3).u1(4).u2(1).u2(1).u2(0);
  // The slave has no code: 3 bits of -4 and zeros.
  b.u1(1).u1(0).u1(7).u1(4).u4(0).i4(1000).u2(0).i1(0).u1(100).u2(7).u1(0).u1(1);
  b.u1(3).u1(5).u1(100).u1(4).i1(3).u1(0).u2(0).u2(1).u2(10000);
  const auto recording = sbf_observations_of(block(b.str(), 3));
  ASSERT_EQ(sbf_signals_of(recording.epochs.at(0)), "G061C G062L G071C ");
  const auto& o = recording.epochs[0].observations;
  EXPECT_EQ(o[0].code_m, 4 * 4'294'967.296);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_FALSE(o[i].phase_cycles);
    EXPECT_FALSE(o[i].doppler_hz);
    EXPECT_FALSE(o[i].half_cycle);
    EXPECT_FALSE(o[i].lost_lock);
  }
  EXPECT_FALSE(o[0].cn0_dbhz);
  EXPECT_EQ(o[1].cn0_dbhz, 35.0);
  EXPECT_TRUE(o[2].phase_cycles);
}

TEST(SbfObservations, ShowALossOfLockAtTheNextPhase) {
  // Lock times at epochs of one second; slaves are cut to 254 s.
  struct Step {
    unsigned master, slave;
    bool half;
    bool lost_master, lost_slave;
  };
  const std::vector<Step> steps = {{300, 250, false, true, true},   {301, 251, false, false, false},
                                   {302, 254, false, false, false}, {303, 254, false, false, false},
                                   {0, 254, false, true, false},    {1, 3, true, false, true},
                                   {2, 4, true, false, false},      {3, 5, false, true, false},
                                   {3, 6, false, false, false},     {0, 0, false, true, true}};
  std::string content;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    SbfSatelliteSent g = gps_satellite();
    g.signals.pop_back();
    g.signals[0].lock = steps[i].master;
    g.signals[1].lock = steps[i].slave;
    g.signals[0].half_cycle = steps[i].half;
    content += meas_epoch({g}, kSbfTestTow + 1000 * static_cast<std::uint32_t>(i));
  }
  const auto recording = sbf_observations_of(content);
  ASSERT_EQ(recording.epochs.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(recording.epochs[i].observations[0].lost_lock, steps[i].lost_master) << i;
    EXPECT_EQ(recording.epochs[i].observations[1].lost_lock, steps[i].lost_slave) << i;
  }
  // After a pause longer than the lock, and in the first second after a loss at a high rate.
  SbfSatelliteSent g = gps_satellite();
  g.signals.resize(1);
  g.signals[0].lock = 20;
  const std::string before = meas_epoch({g});
  EXPECT_TRUE(sbf_observations_of(before + meas_epoch({g}, kSbfTestTow + 21'000)).epochs[1].observations[0].lost_lock);
  EXPECT_FALSE(sbf_observations_of(before + meas_epoch({g}, kSbfTestTow + 20'000)).epochs[1].observations[0].lost_lock);
  g.signals[0].lock = 0;
  EXPECT_TRUE(sbf_observations_of(meas_epoch({g}) + meas_epoch({g}, kSbfTestTow + 100)).epochs[1].observations[0].lost_lock);
}

TEST(SbfObservations, CountWhatIsLeftOut) {
  SbfSatelliteSent main = gps_satellite(), both = gps_satellite();
  both.svid = 9;
  both.signals[2].antenna = 1;
  const std::string good = meas_epoch({main, both});
  std::string too_many = meas_epoch({main}).substr(14);
  too_many[0] = 9;
  const auto recording =
      sbf_observations_of(meas_epoch({main}, 0xffffffff) + meas_epoch({main}, 1000, 0, 65535) + good + good +
                          meas_epoch({main}, kSbfTestTow - 1000) + sbf(4027, too_many) +
                          meas_epoch({main}, kSbfTestTow + 1000, 0x80) + meas_epoch({}, kSbfTestTow + 2000) + sbf(4027, "ab"));
  ASSERT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(sbf_signals_of(recording.epochs[0]), "G051C G052L G052W G091C G092W ");
  const std::map<std::string, long> expected = {{"sbf_no_time", 2},      {"sbf_repeated_epoch", 1}, {"sbf_reversed_epoch", 1},
                                                {"sbf_spoiled", 2},      {"sbf_scrambled", 1},      {"sbf_empty", 1},
                                                {"sbf_other_antenna", 1}};
  for (const auto& [kind, number] : expected) EXPECT_EQ(test::count_of(recording.events, kind), number) << kind;
}

TEST(SbfObservations, HaveTheNamesAndThePlaceOfTheReceiver) {
  SbfPvt none, fix;
  none.mode = 0;
  none.error = 1;
  const auto recording =
      sbf_observations_of(test::receiver_setup("ROOF", "SEPCHOKE_B3E6   SPKE", "mosaic-H") + sbf_pvt(4007, none) +
                          sbf_pvt(4007, fix) + meas_epoch({gps_satellite()}) + sbf(4109, "zip"));
  EXPECT_EQ(recording.marker, "ROOF");
  EXPECT_EQ(recording.antenna, "SEPCHOKE_B3E6   SPKE");
  EXPECT_EQ(recording.receiver, "Septentrio mosaic-H");
  EXPECT_EQ(recording.antenna_offset_enu, Eigen::Vector3d(0.5, -0.25, 1.25));
  EXPECT_LT((recording.approximate_r_e.value() - geo::ecef_from_geodetic({fix.a, fix.b, fix.c})).norm(), 1e-6);
  EXPECT_EQ(test::count_of(recording.events, "messages_not_read"), 1);
  const auto unset = sbf_observations_of(test::receiver_setup("", "Unknown", "") + meas_epoch({gps_satellite()}));
  EXPECT_EQ(unset.antenna, "");
  EXPECT_EQ(unset.receiver, "GRB0051");
  EXPECT_FALSE(unset.approximate_r_e);
}

TEST(SbfObservations, OfOtherBlocksAreNamed) {
  EXPECT_NE(refusal([] { sbf_observations_of(sbf(4109, "zip")); }).find("Meas3Ranges is not read"), std::string::npos);
  EXPECT_NE(refusal([] { sbf_observations_of(meas_epoch({gps_satellite()}, kSbfTestTow, 0x80)); }).find("scrambled"),
            std::string::npos);
}

TEST(SbfFixes, HaveTheTimeAndTheCovariancesOfTheirEpoch) {
  SbfPvt second, third;
  second.tow_ms += 200;
  second.mode = 1;
  third.tow_ms += 400;
  third.clock_bias_ms = kSbfUnknown;
  third.v1 = third.v2 = third.v3 = kSbfUnknown;
  const Files files;
  files.put("a.dat", sbf_pvt(4007, {}) + sbf_covariance(5906, {0.04F, 0.09F, 0.16F, 0.01F, 0.02F, -0.03F}) +
                         sbf_covariance(5908, {0.01F, 0.02F, 0.03F, 0.001F, 0.002F, -0.003F}) + sbf_pvt(4007, second) +
                         sbf_covariance(5906, {-2e10F, 1.0F, 1.0F, 0.0F, 0.0F, 0.0F}, second.tow_ms) + sbf_pvt(4007, third));
  const auto recording = files.gnss("a.dat");
  ASSERT_EQ(recording.fixes.size(), 3U);
  const record::GnssFix& fix = recording.fixes[0];
  EXPECT_NEAR(fix.t - kSbfStart, -0.4e-3, 1e-9);
  EXPECT_LT((fix.r_ea_e - geo::ecef_from_geodetic({0.85, 0.16, 350.123})).norm(), 1e-6);
  Eigen::Matrix3d position, velocity;
  position << 0.04, 0.01, -0.02, 0.01, 0.09, 0.03, -0.02, 0.03, 0.16;
  velocity << 0.01, 0.001, -0.002, 0.001, 0.02, 0.003, -0.002, 0.003, 0.03;
  EXPECT_TRUE(fix.position_cov_n.isApprox(position, 1e-6)) << fix.position_cov_n;
  ASSERT_TRUE(fix.velocity);
  EXPECT_EQ(fix.velocity->v_ea_n, Eigen::Vector3d(1.5, -2.5, -0.25));
  EXPECT_TRUE(fix.velocity->cov_n.isApprox(velocity, 1e-6)) << fix.velocity->cov_n;
  EXPECT_EQ(fix.quality, record::FixQuality::kFixed);
  EXPECT_EQ(fix.satellites, 17);
  // Without a covariance: 6 cm and 10 cm are twice the distance and the standard deviation.
  const Eigen::Vector3d variances(0.03 * 0.03 / 2.0, 0.03 * 0.03 / 2.0, 0.05 * 0.05);
  EXPECT_TRUE(recording.fixes[1].position_cov_n.isApprox(Eigen::Matrix3d(variances.asDiagonal()), 1e-9));
  EXPECT_FALSE(recording.fixes[1].velocity);
  EXPECT_EQ(recording.fixes[1].quality, record::FixQuality::kSingle);
  EXPECT_NEAR(recording.fixes[2].t - kSbfStart, 0.4, 1e-9);
}

TEST(SbfFixes, OfCartesianBlocksAreTheSame) {
  const geo::Geodetic p{0.85, 0.16, 350.123};
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  const Eigen::Vector3d r = geo::ecef_from_geodetic(p), v = C_n_e * Eigen::Vector3d(1.5, -2.5, -0.25);
  Eigen::Matrix3d cov_n;
  cov_n << 0.04, 0.01, -0.02, 0.01, 0.09, 0.03, -0.02, 0.03, 0.16;
  const Eigen::Matrix3d c = C_n_e * cov_n * C_n_e.transpose();
  const auto f = [](double value) { return static_cast<float>(value); };
  SbfPvt sent;
  sent.a = r.x();
  sent.b = r.y();
  sent.c = r.z();
  sent.v1 = v.x();
  sent.v2 = v.y();
  sent.v3 = v.z();
  const std::vector<float> six = {f(c(0, 0)), f(c(1, 1)), f(c(2, 2)), f(c(0, 1)), f(c(0, 2)), f(c(1, 2))};
  const Files files;
  files.put("a.sbf", sbf_pvt(4006, sent) + sbf_covariance(5905, six) + sbf_covariance(5907, six));
  const auto recording = files.gnss("a.sbf");
  ASSERT_EQ(recording.fixes.size(), 1U);
  EXPECT_EQ(recording.fixes[0].r_ea_e, r);
  EXPECT_TRUE(recording.fixes[0].position_cov_n.isApprox(cov_n, 1e-5));
  EXPECT_TRUE(recording.fixes[0].velocity->v_ea_n.isApprox(Eigen::Vector3d(1.5, -2.5, -0.25), 1e-6));
  EXPECT_TRUE(recording.fixes[0].velocity->cov_n.isApprox(cov_n, 1e-5));
}

TEST(SbfFixes, HaveTheQualityOfTheirModeAndNoOthersAreRead) {
  using enum record::FixQuality;
  const std::vector<std::pair<unsigned, record::FixQuality>> read = {{1, kSingle}, {2, kDgps}, {4, kFixed},   {5, kFloat},
                                                                     {6, kSbas},   {10, kPpp}, {0x44, kFixed}};
  std::string content;
  SbfPvt p;
  const auto add = [&](unsigned mode, unsigned error) {
    p.tow_ms += 1000;
    p.mode = mode;
    p.error = error;
    content += sbf_pvt(4007, p);
  };
  for (const auto& [mode, quality] : read) add(mode, 0);
  for (const unsigned mode : {0U, 0x84U, 3U, 7U, 8U}) add(mode, 0);
  add(4, 4);
  p.a = kSbfUnknown;
  add(4, 0);
  p.a = 0.85;
  p.datum = 30;
  add(4, 0);
  p.horizontal_cm = 65535;
  add(4, 0);
  const Files files;
  files.put("a.sbf", content);
  const auto recording = files.gnss("a.sbf");
  ASSERT_EQ(recording.fixes.size(), read.size() + 1);
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(recording.fixes[i].quality, read[i].second) << read[i].first;
  const std::map<std::string, long> expected = {
      {"no_solution", 7}, {"fix_not_measured", 3}, {"fix_no_accuracy", 1}, {"fix_datum", 1}};
  for (const auto& [kind, number] : expected) EXPECT_EQ(test::count_of(recording.events, kind), number) << kind;
}

TEST(SbfFixes, WithoutAWeekNeedOne) {
  SbfPvt p;
  p.week = 65535;
  p.clock_bias_ms = 0.0;
  const Files files;
  files.put("a.sbf", sbf_pvt(4007, p));
  EXPECT_NE(refusal([&] { files.gnss("a.sbf"); }).find("gps_week"), std::string::npos);
  EXPECT_EQ(files.gnss("a.sbf", "gps_week: 2360").fixes.at(0).t, kSbfStart);
}

TEST(SbfImu, HasItsUnitsAndItsTimes) {
  std::string content;
  for (unsigned i = 0; i < 50; ++i)
    content += ext_sensor_meas(kSbfTestTow + 20 * i, {{0, 0.1, -0.2, 9.8 + 0.001 * i}, {1, 1.5, -2.5, 90.0}, {4, 1, 2, 3}},
                               i == 3    ? 5820
                               : i == 30 ? -1234
                                         : -32768);
  const Files files;
  files.put("a.dat", content);
  const auto imu = files.imu("a.dat");
  ASSERT_EQ(imu.samples.size(), 50U);
  EXPECT_NEAR(imu.rate_hz, 50.0, 1e-6);
  const record::ImuSample& s = imu.samples[10];
  EXPECT_EQ(s.t, geo::GpsTime::from_week(kSbfTestWeek, 1e-3 * (kSbfTestTow + 200)));
  EXPECT_TRUE(s.dtheta.isApprox(0.02 * geo::kDegree * Eigen::Vector3d(1.5, -2.5, 90.0), 1e-9));
  EXPECT_TRUE(s.dv.isApprox(0.02 * Eigen::Vector3d(0.1, -0.2, 9.81), 1e-9));
  EXPECT_FLOAT_EQ(imu.temperature.at(0), 58.2F);
  EXPECT_FLOAT_EQ(imu.temperature.at(29), 58.2F);
  EXPECT_FLOAT_EQ(imu.temperature.at(49), -12.34F);
}

TEST(SbfImu, LeavesOutWhatIsNotKnown) {
  const std::vector<test::SbfImuSet> good = {{0, 0.1, -0.2, 9.8}, {1, 1.5, -2.5, 0.5}};
  std::vector<test::SbfImuSet> unknown = good, other = good;
  unknown[1].y = kSbfUnknown;
  other.push_back({0, 5.0, 5.0, 5.0, 11});
  std::string content = ext_sensor_meas(kSbfTestTow, good, -32768, 65535);
  for (unsigned i = 1; i < 20; ++i) content += ext_sensor_meas(kSbfTestTow + 20 * i, i == 5 ? unknown : i == 7 ? other : good);
  content += ext_sensor_meas(kSbfTestTow + 400, {good[0]});
  const Files files;
  files.put("a.sbf", content);
  const auto imu = files.imu("a.sbf");
  EXPECT_EQ(imu.samples.size(), 18U);
  EXPECT_TRUE(imu.temperature.empty());
  for (const char* kind : {"imu_no_time", "nan_row", "imu_other_sensor", "imu_gap"})
    EXPECT_EQ(test::count_of(imu.events, kind), 1) << kind;
}

TEST(SbfTimeMarks, AreInGpsTime) {
  const Files files;
  const auto path = files.put(
      "a.sbf", ext_event(kSbfTestTow + 500, 2, 1, 0.000'25F, -0.000'125) + ext_event(kSbfTestTow, 1, 0, 0.0005F, 0.0001) +
                   ext_event(kSbfTestTow, 1, 0, 0.0F, kSbfUnknown) + ext_event(0xffffffff, 1, 0, 0.0F, 0.0));
  const auto marks = read_time_marks(TimeMarkFileOptions::of_file(path));
  ASSERT_EQ(marks.marks.size(), 2U);
  EXPECT_NEAR(marks.marks[0].t - kSbfStart, 0.0004, 1e-9);
  EXPECT_EQ(marks.marks[0].edge, record::Edge::kRising);
  EXPECT_EQ(marks.marks[0].channel, 1);
  EXPECT_NEAR(marks.marks[1].t - kSbfStart, 0.500375, 1e-9);
  EXPECT_EQ(marks.marks[1].edge, record::Edge::kFalling);
  EXPECT_EQ(marks.marks[1].channel, 2);
  EXPECT_EQ(test::count_of(marks.events, "time_mark_invalid"), 2);
}

TEST(SbfObservations, AreThoseThatConvbinReads) {
  if (std::system("command -v convbin >/dev/null") != 0) GTEST_SKIP() << "convbin (Debian's rtklib) is not installed";
  const Files files;
  SbfSignalSent e1, e5b;
  e1 = {17, kL1, 27'000'000.5, 0.0, 2000.5, 44.0, 100, false, 0};
  e1.phase = e1.code * kL1 / 299'792'458.0 + 1234.5;
  e5b = {21, kE5b, 27'000'003.25, 0.0, 2000.5 * kE5b / kL1, 47.0, 100, false, 0};
  e5b.phase = e5b.code * kE5b / 299'792'458.0 - 4321.5;
  std::string content;
  for (unsigned i = 0; i < 5; ++i) content += meas_epoch({gps_satellite(), {81, {e1, e5b}, 0}}, kSbfTestTow + 1000 * i);
  const auto file = files.put("rover.sbf", content);
  const auto rinex = files.path("rover.obs");
  const std::string command = "convbin -r sbf -v 3.04 -f 7 -od -os -o " + rinex.string() + " " + file.string();
  ASSERT_EQ(std::system((command + " >/dev/null 2>&1").c_str()), 0);
  const auto ours = read_observations(file), theirs = read_observations(rinex);
  ASSERT_EQ(theirs.epochs.size(), ours.epochs.size());
  for (std::size_t i = 0; i < ours.epochs.size(); ++i) {
    ASSERT_EQ(sbf_signals_of(theirs.epochs[i]), sbf_signals_of(ours.epochs[i]));
    for (std::size_t k = 0; k < ours.epochs[i].observations.size(); ++k) {
      const record::Observation &a = ours.epochs[i].observations[k], &b = theirs.epochs[i].observations[k];
      EXPECT_NEAR(*a.code_m, *b.code_m, 0.6e-3);
      EXPECT_NEAR(*a.phase_cycles, *b.phase_cycles, 0.6e-3);
      EXPECT_NEAR(*a.doppler_hz, *b.doppler_hz, 0.6e-3);
      EXPECT_EQ(a.half_cycle, b.half_cycle);
    }
  }
}

}  // namespace
}  // namespace coast::io
