// UBX files of known content, put together field by field.

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/rinex.hpp"
#include "coast/io/time_marks.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/ubx_messages.hpp"

namespace coast::io {
namespace {

using test::esf_meas;
using test::esf_raw;
using test::Files;
using test::nav_hpposllh;
using test::nav_pvt;
using test::Pvt;
using test::rawx;
using test::RawxSignal;
using test::refusal;
using test::ubx;

constexpr unsigned kUbxTestWeek = 2244;
const geo::GpsTime kUbxTestStart = geo::GpsTime::from_week(kUbxTestWeek, 36000.0);

record::ObservationRecording observations_of(const std::string& content) {
  const Files files;
  return read_observations(files.put("rover.ubx", content));
}

std::string signals_of(const record::ObservationEpoch& epoch) {
  std::string text;
  for (const record::Observation& o : epoch.observations)
    text += record::to_string(o.satellite) + o.signal.band + o.signal.tracking + " ";
  return text;
}

TEST(UbxObservations, HaveTheirNumbers) {
  const std::string version(40, ' ');
  const std::string module = std::string("MOD=ZED-F9P") + std::string(19, '\0');
  const auto recording =
      observations_of(test::nmea("GNGGA,,,,,,0") + ubx(0x0a, 0x04, version + module) +
                      rawx(kUbxTestWeek, 36000.0, {RawxSignal{}}) + rawx(kUbxTestWeek, 36000.2, {RawxSignal{}}));
  EXPECT_EQ(recording.receiver, "u-blox ZED-F9P");
  ASSERT_EQ(recording.epochs.size(), 2U);
  EXPECT_EQ(recording.epochs[1].t, geo::GpsTime::from_week(kUbxTestWeek, 36000.2));
  const record::Observation& o = recording.epochs[0].observations.at(0);
  EXPECT_EQ(record::to_string(o.satellite), "G05");
  EXPECT_EQ(o.code_m, 21'000'000.125);
  EXPECT_EQ(o.phase_cycles, 110'000'000.25);
  EXPECT_EQ(o.doppler_hz, -1234.5);
  EXPECT_EQ(o.cn0_dbhz, 45.0);
  EXPECT_FALSE(o.half_cycle);
}

TEST(UbxObservations, OfEverySystemHaveTheNamesOfRinex) {
  const std::vector<std::array<unsigned, 3>> ids = {
      {0, 1, 0},  {0, 1, 3}, {0, 1, 4}, {0, 1, 6},  {0, 32, 7}, {6, 1, 0}, {6, 24, 2},  {2, 1, 0},  {2, 1, 1},
      {2, 1, 3},  {2, 1, 4}, {2, 1, 5}, {2, 36, 6}, {3, 1, 1},  {3, 2, 0}, {3, 2, 2},   {3, 2, 3},  {3, 63, 4},
      {3, 63, 7}, {5, 1, 0}, {5, 1, 4}, {5, 1, 5},  {5, 10, 9}, {7, 2, 0}, {1, 123, 0}, {1, 158, 0}};
  std::vector<RawxSignal> signals;
  for (const auto& id : ids) {
    RawxSignal s;
    s.gnss = id[0];
    s.sv = id[1];
    s.signal = id[2];
    s.frequency = 5;
    signals.push_back(s);
  }
  // B2I of D1 and D2 are one signal: the second is left out, as are satellites and signals that do not exist.
  for (const std::array<unsigned, 3>& id :
       std::vector<std::array<unsigned, 3>>{{0, 33, 0}, {0, 0, 0}, {6, 255, 0}, {4, 1, 0}, {0, 1, 1}}) {
    RawxSignal s;
    s.gnss = id[0];
    s.sv = id[1];
    s.signal = id[2];
    signals.push_back(s);
  }
  const auto recording = observations_of(rawx(kUbxTestWeek, 36000.0, signals));
  EXPECT_EQ(signals_of(recording.epochs.at(0)),
            "G011C G012L G012S G015I G325Q R011C R242C E011B E011C E015I E015Q E017I E367Q C012I C022I C027I C635P C636I J011C "
            "J012L J012S J105Q I025A S231C S581C ");
  EXPECT_EQ(recording.glonass_channels, (std::map<int, int>{{1, -2}, {24, -2}}));
  EXPECT_EQ(test::count_of(recording.events, "rawx_unknown_signal"), 5);
  EXPECT_EQ(test::count_of(recording.events, "rawx_repeated_signal"), 1);
}

TEST(UbxObservations, LoseLockWhereTheTimeOfLockSaysSo) {
  struct Step {
    double t;
    unsigned lock_ms, tracking;
    bool lost;
  };
  const std::vector<Step> steps = {
      {0.0, 64500, 15, true},    // a signal begins
      {1.0, 64500, 15, false},   // saturated
      {2.0, 500, 15, true},      // locked again
      {3.0, 700, 15, true},      // longer than before, but not since then
      {4.0, 1700, 15, false},    //
      {5.0, 2700, 7, true},      // half a cycle is no longer subtracted
      {6.0, 3700, 7, false},     //
      {7.0, 4700, 5, false},     // no phase
      {8.0, 0, 5, false},        // a loss without a phase ..
      {9.0, 1000, 7, true},      // .. waits for the next one
      {10.0, 2000, 7, false},    //
      {80.0, 64500, 7, true},    // a pause longer than what the time of lock can say
      {140.0, 64500, 7, false},  // one that is not
      {141.0, 64500, 3, false},  // half cycles not known
  };
  std::string content;
  for (const Step& step : steps) {
    RawxSignal s;
    s.lock_ms = step.lock_ms;
    s.tracking = step.tracking;
    content += rawx(kUbxTestWeek, 36000.0 + step.t, {s});
  }
  const auto recording = observations_of(content);
  ASSERT_EQ(recording.epochs.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const record::Observation& o = recording.epochs[i].observations.at(0);
    EXPECT_EQ(o.lost_lock, steps[i].lost) << steps[i].t;
    EXPECT_EQ(o.phase_cycles.has_value(), (steps[i].tracking & 2U) != 0) << steps[i].t;
    EXPECT_EQ(o.half_cycle, steps[i].tracking == 3U) << steps[i].t;
  }
}

TEST(UbxObservations, ThatCannotBeAreLeftOutAndCounted) {
  RawxSignal far, infinite, no_phase, nothing;
  far.code = 1e12;
  infinite.sv = 6;
  infinite.phase = std::nan("");
  no_phase.sv = 7;
  no_phase.phase_sd = 15;
  no_phase.cn0 = 0;
  nothing.sv = 8;
  nothing.tracking = 0;
  std::string cut = rawx(kUbxTestWeek, 36001.0, {RawxSignal{}});
  cut = ubx(0x02, 0x15, cut.substr(6, cut.size() - 9));
  const auto recording =
      observations_of(rawx(0, 10.0, {RawxSignal{}}) + rawx(kUbxTestWeek, 36000.0, {far, infinite, no_phase, nothing}) +
                      rawx(kUbxTestWeek, 36000.0, {RawxSignal{}}) + rawx(kUbxTestWeek, 35999.0, {RawxSignal{}}) + cut +
                      rawx(kUbxTestWeek, 36002.0, {}) + rawx(kUbxTestWeek, 700000.0, {RawxSignal{}}) +
                      rawx(kUbxTestWeek, 36003.0, {nothing}) + rawx(kUbxTestWeek, 36004.0, {RawxSignal{}}, 3));
  ASSERT_EQ(recording.epochs.size(), 2U);
  EXPECT_EQ(signals_of(recording.epochs[0]), "G071C ");
  EXPECT_FALSE(recording.epochs[0].observations[0].phase_cycles);
  EXPECT_FALSE(recording.epochs[0].observations[0].cn0_dbhz);
  const std::map<std::string, long> expected = {{"rawx_impossible", 2},     {"rawx_no_time", 2},        {"rawx_spoiled", 1},
                                                {"rawx_repeated_epoch", 1}, {"rawx_reversed_epoch", 1}, {"rawx_empty", 2},
                                                {"rawx_clock_reset", 1}};
  for (const auto& [kind, number] : expected) EXPECT_EQ(test::count_of(recording.events, kind), number) << kind;
}

TEST(UbxFixes, HaveTheTimeAndTheAccuraciesOfNavPvt) {
  Pvt first, second;
  first.nano = -123'456;
  second.tow_ms += 200;
  second.nano = 200'000'000;
  second.flags = 1;
  const Files files;
  files.put_gzip("gnss.ubx.gz", nav_pvt(first) + rawx(kUbxTestWeek, 36000.0, {}) + nav_pvt(second));
  const auto recording = files.gnss("gnss.ubx.gz");
  ASSERT_EQ(recording.fixes.size(), 2U);
  const record::GnssFix& fix = recording.fixes[0];
  EXPECT_EQ(fix.t.nanoseconds(), kUbxTestStart.nanoseconds() - 123'456);
  EXPECT_EQ(recording.fixes[1].t, kUbxTestStart + 0.2);
  const auto place = geo::ecef_from_geodetic({48.7 * geo::kDegree, 9.3 * geo::kDegree, 350.123});
  EXPECT_LT((fix.r_ea_e - place).norm(), 1e-6);
  EXPECT_NEAR(fix.position_cov_n(0, 0), 0.5 * 0.014 * 0.014, 1e-15);
  EXPECT_NEAR(fix.position_cov_n(1, 1), 0.5 * 0.014 * 0.014, 1e-15);
  EXPECT_NEAR(fix.position_cov_n(2, 2), 0.02 * 0.02, 1e-15);
  ASSERT_TRUE(fix.velocity);
  EXPECT_LT((fix.velocity->v_ea_n - Eigen::Vector3d(1.5, -2.5, 0.25)).norm(), 1e-12);
  EXPECT_NEAR(fix.velocity->cov_n.trace(), 0.03 * 0.03, 1e-15);
  EXPECT_EQ(fix.quality, record::FixQuality::kFixed);
  EXPECT_EQ(recording.fixes[1].quality, record::FixQuality::kSingle);
  EXPECT_EQ(fix.satellites, 17);
}

TEST(UbxFixes, TakeDigitsAndCovariancesOfTheSameEpoch) {
  Pvt p, q;
  q.tow_ms += 1000;
  q.second += 1;
  test::Bytes cov;
  cov.u4(p.tow_ms).u1(0).u1(1).u1(1).zeros(9);
  for (const float c : {4e-4F, 1e-4F, 0.0F, 9e-4F, -1e-4F, 16e-4F, 0.01F, 0.0F, 0.0F, 0.02F, 0.0F, 0.03F}) cov.r4(c);
  const Files files;
  files.put("gnss.ubx", nav_pvt(p) + nav_hpposllh(p, 37, -42, 9, 101, 123) + ubx(0x01, 0x36, cov.str()) +
                            nav_hpposllh(q, 0, 0, 0, 140, 200, 1) + nav_pvt(q));
  const auto fixes = files.gnss("gnss.ubx").fixes;
  ASSERT_EQ(fixes.size(), 2U);
  const auto place = geo::ecef_from_geodetic({(48.7 - 42e-9) * geo::kDegree, (9.3 + 37e-9) * geo::kDegree, 350.1239});
  EXPECT_LT((fixes[0].r_ea_e - place).norm(), 1e-6);
  Eigen::Matrix3d expected;
  expected << 4e-4, 1e-4, 0, 1e-4, 9e-4, -1e-4, 0, -1e-4, 16e-4;
  EXPECT_LT((fixes[0].position_cov_n - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(fixes[0].velocity->cov_n(2, 2), 0.03, 1e-8);
  // NAV-HPPOSLLH that is not valid, and no covariance: NAV-PVT alone.
  EXPECT_NEAR(fixes[1].position_cov_n(2, 2), 0.02 * 0.02, 1e-15);
}

TEST(UbxFixes, OfHighPrecisionAloneTakeTheWeekFromElsewhere) {
  Pvt p;
  const Files files;
  files.put("gnss.ubx", nav_hpposllh(p, 0, 0, 0, 100, 200));
  EXPECT_EQ(files.gnss("gnss.ubx", "gps_week: 2244").fixes.at(0).t, kUbxTestStart);
  EXPECT_EQ(files.gnss("gnss.ubx", "", kUbxTestStart + 86400.0).fixes.at(0).t, kUbxTestStart);
  EXPECT_NE(refusal([&] { (void)files.gnss("gnss.ubx"); }).find("State `gps_week:`"), std::string::npos);
  // A message that states the week is enough.
  files.put("timed.ubx", rawx(kUbxTestWeek, 35999.0, {}) + nav_hpposllh(p, 0, 0, 0, 100, 200));
  EXPECT_EQ(files.gnss("timed.ubx").fixes.at(0).t, kUbxTestStart);
}

TEST(UbxFixes, ThatAreNoneAreLeftOutAndCounted) {
  std::string content;
  unsigned tow = 36'000'000;
  const auto add = [&](auto&& change) {
    Pvt p;
    p.tow_ms = tow += 1000;
    p.second = 0;
    p.hour = 10;
    p.minute = 0;
    change(p);
    content += nav_pvt(p);
  };
  add([](Pvt& p) { p.fix = 2; });
  add([](Pvt& p) { p.fix = 1; });
  add([](Pvt& p) { p.flags = 0; });
  add([](Pvt& p) { p.flags3 = 1; });
  add([](Pvt& p) { p.horizontal_mm = 0; });
  add([](Pvt& p) { p.lat = 910'000'000; });
  add([](Pvt& p) { p.fix = 4; });
  add([](Pvt& p) { p.speed_sd = 0; });
  const Files files;
  files.put("gnss.ubx", content);
  const auto recording = files.gnss("gnss.ubx");
  ASSERT_EQ(recording.fixes.size(), 2U);
  EXPECT_FALSE(recording.fixes[1].velocity);
  EXPECT_EQ(test::count_of(recording.events, "no_solution"), 4);
  EXPECT_EQ(test::count_of(recording.events, "fix_no_accuracy"), 2);
  EXPECT_EQ(test::count_of(recording.events, "fix_with_imu"), 1);
  const auto stated = files.gnss("gnss.ubx", "sd_m: [0.1, 0.2, 0.3], velocity_sd_mps: [1, 2, 3]");
  EXPECT_EQ(stated.fixes.size(), 3U);  // without accuracy as well
  EXPECT_DOUBLE_EQ(stated.fixes[0].position_cov_n(2, 2), 0.3 * 0.3);
  EXPECT_DOUBLE_EQ(stated.fixes[0].velocity->cov_n(1, 1), 4.0);
}

/// Rates and forces in the numbers of ESF: x, y, z gyro, x, y, z accelerometer, temperature.
std::vector<std::pair<unsigned, int>> esf_sample(int i) {
  return {{14, 4096 + i}, {13, -8192}, {5, -i}, {12, 3150}, {16, 1024}, {17, -512 - i}, {18, 10035}};
}

TEST(UbxImu, IsReadWithUnitsAndAxes) {
  // A counter of 25.6 kHz that overflows; positions every second, told 80 ms late.
  std::string raw, slow, both;
  for (int i = 0; i < 3000; ++i) {
    const std::uint32_t tag = 4294900000U + 256U * static_cast<std::uint32_t>(i);
    const std::string sample = esf_raw({{tag, esf_sample(i)}});
    raw += sample;
    both += sample;
    const auto all = esf_sample(i);
    if (i % 10 == 0) {
      const std::string rates = esf_meas(static_cast<std::uint32_t>(5000 + 10 * i), {all.begin(), all.begin() + 4});
      const std::string forces = esf_meas(static_cast<std::uint32_t>(5002 + 10 * i), {all.begin() + 4, all.end()});
      slow += rates + forces;
      both += rates + forces;
    }
    if (i % 100 != 8) continue;
    const int second = i / 100;
    const std::string epoch = rawx(kUbxTestWeek, 36000.0 + second, {RawxSignal{}});
    raw += epoch;
    slow += epoch;
    both += epoch;
  }
  const Files files;
  files.put("raw.ubx", raw);
  files.put("slow.ubx", slow);
  const auto fast = files.imu("raw.ubx");
  ASSERT_EQ(fast.samples.size(), 3000U);
  EXPECT_NEAR(fast.rate_hz, 100.0, 1e-3);
  const record::ImuSample& s = fast.samples[1000];
  EXPECT_NEAR(s.t - (kUbxTestStart + 10.0), -0.08, 1e-6);
  const Eigen::Vector3d gyro(1.0 + 1000.0 / 4096.0, -2.0, -1000.0 / 4096.0);
  EXPECT_LT((s.dtheta / s.dt - geo::kDegree * gyro).norm(), 1e-9);
  EXPECT_LT((s.dv / s.dt - Eigen::Vector3d(1.0, -1512.0 / 1024.0, 10035.0 / 1024.0)).norm(), 1e-8);
  EXPECT_FLOAT_EQ(fast.temperature.at(5), 31.5F);
  EXPECT_EQ(test::count_of(fast.events, "imu_clock_tied"), 1);
  const auto tenth = files.imu("slow.ubx");
  ASSERT_EQ(tenth.samples.size(), 300U);
  EXPECT_NEAR(tenth.samples[100].t - (kUbxTestStart + 10.0), -0.08, 0.1);
  EXPECT_NEAR(tenth.rate_hz, 10.0, 1e-3);
  // Both: the one that has every sample.
  files.put("both.ubx", both);
  EXPECT_EQ(files.imu("both.ubx").samples.size(), 3000U);
}

TEST(UbxImu, WithoutGpsTimeOrSensorsIsRefused) {
  const Files files;
  std::string samples;
  for (std::uint32_t i = 0; i < 100; ++i) samples += esf_meas(10 * i, esf_sample(static_cast<int>(i)));
  files.put("untimed.ubx", samples);
  files.put("wheel.ubx", esf_meas(0, {{8, 5}, {9, 5}}));
  files.put("none.ubx", nav_pvt({}));
  EXPECT_NE(refusal([&] { (void)files.imu("untimed.ubx"); }).find("fewer than ten epochs of GPS time"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.imu("wheel.ubx"); }).find("without rates and specific forces"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.imu("none.ubx"); }).find("without UBX-ESF-RAW"), std::string::npos);
}

std::string tim_tm2(unsigned flags, unsigned week, unsigned ms, unsigned ns) {
  test::Bytes b;
  b.u1(0).u1(flags).u2(7).u2(week).u2(week).u4(ms).u4(ns).u4(ms + 20).u4(ns).u4(25);
  return ubx(0x0d, 0x03, b.str());
}

TEST(UbxTimeMarks, AreInGpsTime) {
  constexpr unsigned kValid = 0x40, kRising = 0x80, kFalling = 0x04, kGnss = 0x08, kUtc = 0x10;
  const Files files;
  files.put("marks.ubx", tim_tm2(kValid | kGnss | kRising | kFalling, kUbxTestWeek, 36'000'001, 500'250) +
                             tim_tm2(kValid | kUtc | kRising, kUbxTestWeek, 35'985'000, 0) +
                             tim_tm2(kGnss | kRising, kUbxTestWeek, 36'009'000, 0) +
                             tim_tm2(kValid | kRising, kUbxTestWeek, 36'009'000, 0));
  const auto recording = read_time_marks(TimeMarkFileOptions::of_file(files.path("marks.ubx")));
  ASSERT_EQ(recording.marks.size(), 3U);
  EXPECT_EQ(recording.marks[0].t.nanoseconds(), kUbxTestStart.nanoseconds() + 1'500'250);
  EXPECT_EQ(recording.marks[0].edge, record::Edge::kRising);
  EXPECT_EQ(recording.marks[0].count, 7);
  EXPECT_DOUBLE_EQ(recording.marks[0].sd_s, 25e-9);
  EXPECT_EQ(recording.marks[1].edge, record::Edge::kFalling);
  EXPECT_EQ(recording.marks[2].t, kUbxTestStart + 3.0);
  EXPECT_EQ(test::count_of(recording.events, "time_mark_invalid"), 2);
  files.put("none.ubx", nav_pvt({}));
  EXPECT_NE(refusal([&] { (void)read_time_marks(TimeMarkFileOptions::of_file(files.path("none.ubx"))); }).find("no time mark"),
            std::string::npos);
}

TEST(UbxFile, SaysWhatItHasInstead) {
  const Files files;
  files.put("pvt.ubx", nav_pvt({}));
  files.put("rawx.ubx", rawx(kUbxTestWeek, 36000.0, {RawxSignal{}}));
  files.put("text.ubx", test::nmea("GNGGA,,,,,,0"));
  const auto observations = [&](const char* name) { return refusal([&] { (void)read_observations(files.path(name)); }); };
  EXPECT_NE(observations("pvt.ubx").find("a UBX file without UBX-RXM-RAWX"), std::string::npos);
  EXPECT_NE(observations("text.ubx").find("a UBX file without UBX-RXM-RAWX"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.gnss("rawx.ubx"); }).find("without UBX-NAV-PVT"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)read_navigation(files.path("rawx.ubx")); }).find("without UBX-RXM-SFRBX"), std::string::npos);
  EXPECT_NE(refusal([&] { (void)files.reference("pvt.ubx"); }).find("a UBX file"), std::string::npos);
}

TEST(UbxFile, DamageIsToldWithTheRest) {
  std::string spoiled = rawx(kUbxTestWeek, 36001.0, {RawxSignal{}});
  spoiled[20] = static_cast<char>(spoiled[20] + 1);
  const std::string good = rawx(kUbxTestWeek, 36000.0, {RawxSignal{}});
  const auto recording = observations_of(good + spoiled + "noise" + rawx(kUbxTestWeek, 36002.0, {RawxSignal{}}) +
                                         ubx(0x01, 0x35, "abcdefgh") + good.substr(0, 30));
  EXPECT_EQ(recording.epochs.size(), 2U);
  for (const char* kind : {"message_checksum", "message_garbage", "message_cut_off", "messages_not_read"})
    EXPECT_GT(test::count_of(recording.events, kind), 0) << kind;
}

}  // namespace
}  // namespace coast::io
