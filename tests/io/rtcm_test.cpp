// RTCM 3: numbers that were put into the bits come out, in GPS time, and what is missing or damaged is named.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "coast/geo/units.hpp"
#include "coast/io/contents.hpp"
#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/rtcm_messages.hpp"
#include "io/ubx_messages.hpp"

namespace coast::io {
namespace {

using record::Observation;
using test::BitString;
using test::Files;
using test::glonass_epoch;
using test::LegacySatellite;
using test::Msm;
using test::msm;
using test::MsmCell;
using test::MsmRough;

constexpr double kLight = 299'792'458.0;
constexpr int kStationWeek = 2244;  // of GPS; 196 modulo 1024; 888 of BeiDou; 1220 of Galileo
constexpr int kShortWeek = 196;
constexpr double kStationSecond = 36'000.0;

geo::GpsTime gps_at(double sow, int week = kStationWeek) {
  return geo::GpsTime::from_week(week, sow);
}

std::string in_week(const std::string& messages) {
  return test::rtcm_1019(3, kShortWeek) + messages;
}

record::ObservationRecording rtcm_observations_of(const std::string& content, std::optional<geo::GpsTime> near = std::nullopt) {
  const Files files;
  return read_observations(files.put("base.rtcm3", content), near);
}

record::NavigationRecording ephemerides_of(const std::string& content) {
  const Files files;
  return read_navigation(files.put("base.rtcm3", content));
}

double metres(double ms) {
  return 1e-3 * kLight * ms;
}

TEST(RtcmMsm, OfEachKindHasItsScales) {
  for (const int kind : {4, 5, 6, 7}) {
    const bool fine = kind >= 6;
    Msm message;
    message.number = 1070 + kind;
    message.cells[0].cn0 = fine ? 700 : 44;
    const auto recording = rtcm_observations_of(in_week(msm(message)));
    ASSERT_EQ(recording.epochs.size(), 1U);
    ASSERT_EQ(recording.epochs[0].observations.size(), 1U);
    EXPECT_EQ(recording.epochs[0].t, gps_at(kStationSecond));
    const Observation& o = recording.epochs[0].observations[0];
    EXPECT_EQ(record::to_string(o.satellite), "G05");
    EXPECT_EQ(o.signal, (record::Signal{'1', 'C'}));
    EXPECT_NEAR(o.code_m.value(), metres(70.5 + 1000 * (fine ? 0x1p-29 : 0x1p-24)), 1e-8);
    EXPECT_NEAR(o.phase_cycles.value(), metres(70.5 - 2000 * (fine ? 0x1p-31 : 0x1p-29)) * 1575.42e6 / kLight, 1e-7);
    EXPECT_EQ(o.cn0_dbhz.value(), fine ? 43.75 : 44.0);
    ASSERT_EQ(o.doppler_hz.has_value(), kind == 5 || kind == 7);
    if (o.doppler_hz) {
      EXPECT_NEAR(*o.doppler_hz, (321.0 - 0.1234) * 1575.42e6 / kLight, 1e-9);
    }
    EXPECT_TRUE(o.lost_lock);  // the first one
    EXPECT_FALSE(o.half_cycle);
  }
}

TEST(RtcmMsm, LeavesOutWhatIsNotMeasured) {
  Msm message;
  message.rough = {{3}, {4, 255}, {5}, {6, 70, 512, 0, -8192}};
  message.cells = {{3}, {4}, {5}, {6}};
  message.cells[0].code = -(1 << 19);
  message.cells[2].phase = -(1 << 23);
  message.cells[2].cn0 = 0;
  message.cells[2].half = 1;
  message.cells[0].half = 1;
  const auto recording = rtcm_observations_of(in_week(msm(message)));
  ASSERT_EQ(recording.epochs[0].observations.size(), 3U);  // nothing of the one without a range
  const auto& all = recording.epochs[0].observations;
  EXPECT_FALSE(all[0].code_m);
  EXPECT_TRUE(all[0].phase_cycles);
  EXPECT_TRUE(all[0].half_cycle);
  EXPECT_FALSE(all[1].phase_cycles);
  EXPECT_FALSE(all[1].cn0_dbhz);
  EXPECT_FALSE(all[1].half_cycle);
  EXPECT_FALSE(all[2].doppler_hz);
  EXPECT_TRUE(all[1].doppler_hz);
}

/// RTCM 10403.3, tables 3.5-91 to -108: place, RINEX code.
TEST(RtcmMsm, HasTheSignalsOfEachSystem) {
  struct Table {
    int number;
    char letter;
    std::vector<std::pair<int, std::string>> signals;
  };
  const std::vector<Table> tables = {{1077,
                                      'G',
                                      {{2, "1C"},
                                       {3, "1P"},
                                       {4, "1W"},
                                       {8, "2C"},
                                       {9, "2P"},
                                       {10, "2W"},
                                       {15, "2S"},
                                       {16, "2L"},
                                       {17, "2X"},
                                       {22, "5I"},
                                       {23, "5Q"},
                                       {24, "5X"},
                                       {30, "1S"},
                                       {31, "1L"},
                                       {32, "1X"}}},
                                     {1087, 'R', {{2, "1C"}, {3, "1P"}, {8, "2C"}, {9, "2P"}}},
                                     {1097,
                                      'E',
                                      {{2, "1C"},
                                       {3, "1A"},
                                       {4, "1B"},
                                       {5, "1X"},
                                       {6, "1Z"},
                                       {8, "6C"},
                                       {9, "6A"},
                                       {10, "6B"},
                                       {11, "6X"},
                                       {12, "6Z"},
                                       {14, "7I"},
                                       {15, "7Q"},
                                       {16, "7X"},
                                       {18, "8I"},
                                       {19, "8Q"},
                                       {20, "8X"},
                                       {22, "5I"},
                                       {23, "5Q"},
                                       {24, "5X"}}},
                                     {1107, 'S', {{2, "1C"}, {22, "5I"}, {23, "5Q"}, {24, "5X"}}},
                                     {1117,
                                      'J',
                                      {{2, "1C"},
                                       {9, "6S"},
                                       {10, "6L"},
                                       {11, "6X"},
                                       {15, "2S"},
                                       {16, "2L"},
                                       {17, "2X"},
                                       {22, "5I"},
                                       {23, "5Q"},
                                       {24, "5X"},
                                       {30, "1S"},
                                       {31, "1L"},
                                       {32, "1X"}}},
                                     {1127,
                                      'C',
                                      {{2, "2I"},
                                       {3, "2Q"},
                                       {4, "2X"},
                                       {8, "6I"},
                                       {9, "6Q"},
                                       {10, "6X"},
                                       {14, "7I"},
                                       {15, "7Q"},
                                       {16, "7X"},
                                       {22, "5D"},
                                       {23, "5P"},
                                       {24, "5X"},
                                       {25, "7D"},
                                       {30, "1D"},
                                       {31, "1P"},
                                       {32, "1X"}}},
                                     {1137, 'I', {{8, "9A"}, {22, "5A"}}}};
  for (const Table& table : tables) {
    Msm message;
    message.number = table.number;
    message.rough[0].satellite = 1;
    message.cells.clear();
    for (int place = 1; place <= 32; ++place) message.cells.push_back({1, place});
    if (table.letter == 'R') message.epoch = glonass_epoch(0, 36'000'000 + 10'800'000 - 18'000);
    const auto recording = rtcm_observations_of(in_week(msm(message)));
    std::set<std::string> expected, found;
    for (const auto& [place, name] : table.signals) expected.insert(name);
    for (const Observation& o : recording.epochs.at(0).observations) {
      found.insert({o.signal.band, o.signal.tracking});
      EXPECT_TRUE(o.phase_cycles) << o.signal.band;
      EXPECT_EQ(record::letter(o.satellite.system), table.letter);
      EXPECT_EQ(o.satellite.number, table.letter == 'S' ? 20 : 1);
    }
    EXPECT_EQ(found, expected) << table.letter;
    EXPECT_EQ(test::count_of(recording.events, "rtcm_unknown_signal"), static_cast<long>(32 - table.signals.size()));
    // The order of places is that of the table: the code tells which cell a signal came from.
    for (const auto& [place, name] : table.signals) {
      message.cells = {{1, place}};
      const auto one = rtcm_observations_of(in_week(msm(message)));
      const record::Signal signal = one.epochs.at(0).observations.at(0).signal;
      EXPECT_EQ((std::string{signal.band, signal.tracking}), name) << table.letter << place;
    }
  }
}

TEST(RtcmMsm, OfAllSystemsOfATimeAreOneEpoch) {
  Msm gps, glonass, beidou;
  gps.more = true;
  glonass.number = 1087;
  glonass.epoch = glonass_epoch(0, 36'000'000 + 3 * 3'600'000 - 18'000);  // Sunday in Moscow
  glonass.rough[0].extended = 7 - 4;
  glonass.cells[0].signal = 8;  // 2C
  beidou.number = 1127;
  beidou.epoch = 36'000'000 - 14'000;
  const auto recording = rtcm_observations_of(in_week(msm(gps) + msm(glonass) + msm(beidou)));
  ASSERT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(recording.epochs[0].t, gps_at(kStationSecond));
  const auto& all = recording.epochs[0].observations;
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(record::to_string(all[0].satellite), "G05");
  EXPECT_EQ(record::to_string(all[1].satellite), "R05");
  EXPECT_EQ(record::to_string(all[2].satellite), "C05");
  EXPECT_EQ(recording.glonass_channels, (std::map<int, int>{{5, -4}}));
  EXPECT_NEAR(all[1].phase_cycles.value(), metres(70.5 - 2000 * 0x1p-31) * (1246e6 - 4 * 0.4375e6) / kLight, 1e-7);
  EXPECT_NEAR(all[2].phase_cycles.value(), metres(70.5 - 2000 * 0x1p-31) * 1561.098e6 / kLight, 1e-7);
}

TEST(RtcmMsm, OfGlonassHasTheDayOfMoscow) {
  // 21:30 UTC of a Saturday is 00:30 of Sunday in Moscow: day 0, in the week of GPS that is about to end.
  Msm glonass;
  glonass.number = 1087;
  for (const int day : {0, 7}) {  // 7: not known
    glonass.epoch = glonass_epoch(day, 1'800'000);
    const std::string gps = msm(Msm{.epoch = 595'800'000, .cells = {{}}});
    const auto recording = rtcm_observations_of(test::rtcm_1019(3, kShortWeek, 597'600 / 16) + gps + msm(glonass));
    ASSERT_EQ(recording.epochs.size(), 2U) << day;
    EXPECT_EQ(recording.epochs[1].t, gps_at(604'800.0 - 9000.0 + 18.0)) << day;
  }
}

TEST(RtcmMsm, WithoutFrequencyNumberHasNoPhase) {
  Msm glonass;
  glonass.number = 1084;
  glonass.epoch = glonass_epoch(0, 36'000'000 + 3 * 3'600'000 - 18'000);
  glonass.cells[0].cn0 = 40;
  const auto without = rtcm_observations_of(in_week(msm(glonass)));
  EXPECT_TRUE(without.epochs.at(0).observations.at(0).code_m);
  EXPECT_FALSE(without.epochs[0].observations[0].phase_cycles);
  EXPECT_EQ(test::count_of(without.events, "rtcm_no_channel"), 1);
  // 1020 states it, wherever it comes.
  const auto with = rtcm_observations_of(in_week(msm(glonass) + test::rtcm_1020(5, -3, 51)));
  EXPECT_NEAR(with.epochs.at(0).observations.at(0).phase_cycles.value(),
              metres(70.5 - 2000 * 0x1p-29) * (1602e6 - 3 * 0.5625e6) / kLight, 1e-7);
}

TEST(RtcmMsm, LosesLockWhereTheTimeOfLockIsShort) {
  // DF407: 352 is 10 * 2^10 ms .. beginning with 64: 2 ms a step. Times of lock of 2.048, 3.072, 0.5 and 4 s, each a second on.
  struct Step {
    int lock;
    bool lost;
  };
  // 224: 2.048 s, 256: 4.096 s, 128: 0.256 s, 288: 8.192 s (RTCM 10403.3, table 3.5-74).
  const std::vector<Step> steps = {{224, true}, {256, false}, {128, true}, {256, false}, {255, true}, {288, false}};
  std::string messages;
  std::int64_t ms = 36'000'000;
  for (const Step& step : steps) {
    Msm message;
    message.epoch = ms;
    message.cells[0].lock = step.lock;
    messages += msm(message);
    ms += 1000;
  }
  Msm late;  // 8.192 s of lock after a pause of 9 s
  late.epoch = ms + 8000;
  late.cells[0].lock = 288;
  const auto recording = rtcm_observations_of(in_week(messages + msm(late)));
  ASSERT_EQ(recording.epochs.size(), steps.size() + 1);
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(recording.epochs[i].observations[0].lost_lock, steps[i].lost) << i;
  EXPECT_TRUE(recording.epochs.back().observations[0].lost_lock);
}

TEST(RtcmMsm, OfFourBitsLosesLockLikewise) {
  std::string messages;
  // 6: 1024 ms, 5: 512 ms: of 30 s nothing is certain below 11: 32768 ms.
  const std::vector<std::pair<int, bool>> steps = {{6, true}, {6, false}, {7, false}, {5, true}, {6, false}};
  std::int64_t ms = 36'000'000;
  for (const auto& [lock, lost] : steps) {
    Msm message;
    message.number = 1074;
    message.epoch = ms;
    message.cells[0].lock = lock;
    message.cells[0].cn0 = 40;
    messages += msm(message);
    ms += 1000;
  }
  const auto recording = rtcm_observations_of(in_week(messages));
  ASSERT_EQ(recording.epochs.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(recording.epochs[i].observations[0].lost_lock, steps[i].second) << i;
}

TEST(RtcmWeeks, AreThoseOfAnyMessageThatStatesOne) {
  const std::string epoch = msm(Msm{});
  for (const std::string& week :
       {test::rtcm_1019(3, kShortWeek), test::rtcm_1042(20, 888), test::rtcm_1044(2, kShortWeek),
        test::rtcm_galileo(1045, 7, 1220), test::rtcm_galileo(1046, 7, 1220), test::rtcm_1013(59'952, 35'982, 18)}) {
    EXPECT_EQ(rtcm_observations_of(week + epoch).epochs.at(0).t, gps_at(kStationSecond));
    EXPECT_EQ(rtcm_observations_of(epoch + week).epochs.at(0).t, gps_at(kStationSecond));
  }
}

TEST(RtcmWeeks, OfTenBitsAreTheLatestBefore2031OrNearWhatIsKnown) {
  const std::string content = test::rtcm_1019(3, 686) + msm(Msm{});  // 1710 is in 2012, 2734 in 2032
  EXPECT_EQ(rtcm_observations_of(content).epochs.at(0).t.week(), 1710);
  EXPECT_EQ(rtcm_observations_of(content, gps_at(100.0, 2735)).epochs.at(0).t.week(), 2734);
  // Before 2012 the leap seconds between GPS and GLONASS tell: 15 are of 2009, not of 2029.
  const std::int64_t moscow = 36'000'000 + 3 * 3'600'000 - 15'000;
  const std::string both = test::rtcm_1019(3, 538) + test::legacy(1004, 36'000'000, {{}}) + test::legacy(1012, moscow, {{}});
  const auto recording = rtcm_observations_of(both);
  ASSERT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(recording.epochs[0].t, gps_at(kStationSecond, 1562));
  // One that is not modulo 1024 has the last word.
  EXPECT_EQ(
      rtcm_observations_of(test::rtcm_1019(3, 686) + test::rtcm_galileo(1046, 7, 1710) + msm(Msm{})).epochs.at(0).t.week(),
      2734);
}

TEST(RtcmWeeks, AreFollowedThroughTheirTurn) {
  const std::string before = msm(Msm{.epoch = 604'799'000, .cells = {{}}}), after = msm(Msm{.epoch = 0, .cells = {{}}});
  const std::string last = test::rtcm_1019(3, kShortWeek, 597'600 / 16), next = test::rtcm_1019(3, kShortWeek + 1, 0);
  const std::string early = test::rtcm_1019(4, kShortWeek, 0);  // sent in one week, of the next: says less
  for (const std::string& content : {last + before + after, before + last + after, before + after + next,
                                     early + before + last + after, before + early + after + next}) {
    const auto recording = rtcm_observations_of(content);
    ASSERT_EQ(recording.epochs.size(), 2U);
    EXPECT_EQ(recording.epochs[0].t, gps_at(604'799.0));
    EXPECT_EQ(recording.epochs[1].t, gps_at(604'800.0));
  }
}

TEST(RtcmWeeks, ThatNothingStatesAreAsked) {
  const Files files;
  files.put("base.rtcm3", msm(Msm{}));
  const std::string refusal = test::refusal([&] { (void)read_observations(files.path("base.rtcm3")); });
  EXPECT_NE(refusal.find("nothing that states the GPS week"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("--gps-week"), std::string::npos) << refusal;
  const auto recording = rtcm_observations_of(msm(Msm{}), gps_at(500'000.0, kStationWeek - 1));
  EXPECT_EQ(recording.epochs.at(0).t, gps_at(kStationSecond));
  EXPECT_EQ(test::count_of(recording.events, "rtcm_week_not_stated"), 1);
  // `coast inspect --gps-week` gives the middle of the week.
  EXPECT_EQ(read_contents(files.path("base.rtcm3"), kStationWeek).observations->epochs.at(0).t, gps_at(kStationSecond));
}

TEST(RtcmLegacy, HasCodeAndPhaseOfBothBands) {
  const double code = 0.02 * 1'234'567 + metres(73.0);
  const auto gps = rtcm_observations_of(in_week(test::legacy(1004, 36'000'000, {{}, {.number = 40}})));
  ASSERT_EQ(gps.epochs.size(), 1U);
  const auto& all = gps.epochs[0].observations;
  ASSERT_EQ(all.size(), 3U);  // SBAS has no second band
  EXPECT_EQ(record::to_string(all[0].satellite) + record::to_string(all[2].satellite), "G07S20");
  EXPECT_EQ(all[1].signal, (record::Signal{'2', 'W'}));
  EXPECT_NEAR(all[0].code_m.value(), code, 1e-8);
  EXPECT_NEAR(all[0].phase_cycles.value(), (code - 0.5) * 1575.42e6 / kLight, 1e-7);
  EXPECT_NEAR(all[1].code_m.value(), code - 1.54, 1e-8);
  EXPECT_NEAR(all[1].phase_cycles.value(), (code + 1.0) * 1227.6e6 / kLight, 1e-7);
  EXPECT_EQ(all[0].cn0_dbhz.value(), 45.0);
  EXPECT_EQ(all[1].cn0_dbhz.value(), 42.5);
  const std::int64_t moscow = 36'000'000 + 3 * 3'600'000 - 18'000;
  const LegacySatellite slot{
      .number = 9, .channel = -2, .range = 20'000'000, .whole = 36, .second_code = 1, .difference = -8192};
  const auto glonass =
      rtcm_observations_of(in_week(msm(Msm{.epoch = 35'000'000, .cells = {{}}}) + test::legacy(1012, moscow, {slot})));
  ASSERT_EQ(glonass.epochs.size(), 2U);
  EXPECT_EQ(glonass.epochs[1].t, gps_at(kStationSecond));
  const auto& pair = glonass.epochs[1].observations;
  const double range = 400'000.0 + metres(72.0);
  EXPECT_NEAR(pair.at(0).phase_cycles.value(), (range - 0.5) * (1602e6 - 2 * 0.5625e6) / kLight, 1e-7);
  EXPECT_EQ(pair.at(1).signal, (record::Signal{'2', 'P'}));
  EXPECT_FALSE(pair[1].code_m);
  EXPECT_NEAR(pair[1].phase_cycles.value(), (range + 1.0) * (1246e6 - 2 * 0.4375e6) / kLight, 1e-7);
}

TEST(RtcmLegacy, FollowsThePhaseThroughItsTurns) {
  const double turn = 1500.0 * kLight / 1575.42e6;  // m
  std::string messages;
  for (int i = 0; i < 3; ++i) {
    // The difference of phase and code grows by 40 m a second; the station turns it back when the field is full.
    const double difference = 200.0 + 40.0 * i - (i == 2 ? turn : 0.0);
    LegacySatellite s;
    s.phase = static_cast<int>(std::lround(difference / 0.0005));
    messages += test::legacy(1004, 36'000'000 + 1000 * i, {s});
  }
  const auto recording = rtcm_observations_of(in_week(messages));
  ASSERT_EQ(recording.epochs.size(), 3U);
  const double code = 0.02 * 1'234'567 + metres(73.0);
  EXPECT_NEAR(recording.epochs[2].observations[0].phase_cycles.value(), (code + 280.0) * 1575.42e6 / kLight, 0.002);
  EXPECT_FALSE(recording.epochs[2].observations[0].lost_lock);
}

TEST(RtcmLegacy, IsNotUsedBesideMsm) {
  const auto recording = rtcm_observations_of(in_week(test::legacy(1004, 36'000'000, {{}}) + msm(Msm{})));
  ASSERT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(recording.epochs[0].observations.size(), 1U);
  EXPECT_EQ(test::count_of(recording.events, "rtcm_legacy_left_out"), 1);
}

TEST(RtcmStations, HaveTheirPlaceAntennaAndReceiver) {
  const std::string station = test::rtcm_1006(41'571'770'661, -6'712'304'772, 47'747'670'313, 15'000) +
                              test::rtcm_1033({"TRM59800.00     NONE", "1234", "SEPT POLARX5", "5.4.0", "3001"});
  const auto recording = rtcm_observations_of(in_week(station + msm(Msm{})));
  EXPECT_EQ(recording.antenna, "TRM59800.00     NONE");
  EXPECT_EQ(recording.receiver, "SEPT POLARX5");
  // The reference point is above the marker, along the plumb line of the ellipsoid.
  const Eigen::Vector3d point(4'157'177.0661, -671'230.4772, 4'774'767.0313);
  EXPECT_EQ(recording.antenna_offset_enu, Eigen::Vector3d(0.0, 0.0, 1.5));
  const double latitude = std::asin((point - recording.approximate_r_e.value()).z() / 1.5);
  EXPECT_NEAR((point - *recording.approximate_r_e).norm(), 1.5, 1e-6);
  EXPECT_NEAR(latitude / geo::kDegree, 48.78, 0.01);
  // Those of another station are not its.
  const auto other = rtcm_observations_of(in_week(test::rtcm_1006(41'571'770'661, 6'712'304'772, 47'747'670'313, 0, 13) +
                                                  msm(Msm{}) + msm(Msm{.epoch = 36'001'000, .station = 13, .cells = {{}}})));
  EXPECT_FALSE(other.approximate_r_e);
  EXPECT_EQ(other.epochs.size(), 1U);
  EXPECT_EQ(test::count_of(other.events, "rtcm_other_station"), 1);
}

void expect_orbit(const record::KeplerEphemeris& e, double root, int radius = -5, int harmonic = -29) {
  EXPECT_EQ(e.crs, test::scaled(-1100, radius));
  EXPECT_EQ(e.delta_n, test::angle(12'345, -43));
  EXPECT_EQ(e.mean_anomaly, test::angle(-1'717'986'918, -31));
  EXPECT_EQ(e.cuc, test::scaled(-222, harmonic));
  EXPECT_EQ(e.eccentricity, test::scaled(104'857'600, -33));
  EXPECT_EQ(e.cus, test::scaled(3333, harmonic));
  EXPECT_NEAR(e.sqrt_a, root, 1e-6);
  EXPECT_EQ(e.cic, test::scaled(-44, harmonic));
  EXPECT_EQ(e.node, test::angle(-1'000'000'001, -31));
  EXPECT_EQ(e.cis, test::scaled(55, harmonic));
  EXPECT_EQ(e.inclination, test::angle(657'000'000, -31));
  EXPECT_EQ(e.crc, test::scaled(7001, radius));
  EXPECT_EQ(e.perigee, test::angle(999'999'999, -31));
  EXPECT_EQ(e.node_rate, test::angle(-21'000, -43));
  EXPECT_EQ(e.inclination_rate, test::angle(-777, -43));
}

TEST(RtcmEphemerides, OfGpsAndQzssHaveTheirNumbers) {
  const auto navigation =
      ephemerides_of(test::rtcm_1019(7, kShortWeek) + test::rtcm_1044(2, kShortWeek) + test::rtcm_1019(7, kShortWeek));
  ASSERT_EQ(navigation.kepler.size(), 2U);
  EXPECT_EQ(record::to_string(navigation.kepler[0].satellite), "G07");
  EXPECT_EQ(record::to_string(navigation.kepler[1].satellite), "J02");
  for (const auto& e : navigation.kepler) {
    EXPECT_EQ(e.toe, gps_at(kStationSecond));
    EXPECT_EQ(e.toc, gps_at(kStationSecond));
    EXPECT_EQ(e.issue, 0xa5);
    EXPECT_EQ(e.accuracy_m, 4.0);
    EXPECT_EQ(e.sources, 1);
    EXPECT_EQ(e.group_delay[0], test::scaled(-11, -31));
    EXPECT_EQ(e.clock, (std::array{test::scaled(-345'678, -31), test::scaled(-1234, -43), test::scaled(-1, -55)}));
    expect_orbit(e, 5153.625);
  }
}

TEST(RtcmEphemerides, OfBeidouAreInGpsTime) {
  const auto navigation = ephemerides_of(test::rtcm_1042(20, 888));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  const auto& e = navigation.kepler[0];
  EXPECT_EQ(record::to_string(e.satellite), "C20");
  EXPECT_EQ(e.toe, gps_at(36'014.0));
  EXPECT_EQ(e.toc, gps_at(36'014.0));
  EXPECT_EQ(e.issue, 17);
  EXPECT_EQ(e.health, 1);
  EXPECT_EQ(e.accuracy_m, 4.0);
  EXPECT_NEAR(e.group_delay[0], -5.6e-9, 1e-22);
  EXPECT_NEAR(e.group_delay[1], 3.0e-9, 1e-22);
  EXPECT_EQ(e.clock, (std::array{test::scaled(-345'678, -33), test::scaled(-1234, -50), test::scaled(-3, -66)}));
  expect_orbit(e, 6493.5, -6, -31);
}

TEST(RtcmEphemerides, OfGalileoAreToldApart) {
  const auto navigation = ephemerides_of(test::rtcm_galileo(1045, 7, 1220) + test::rtcm_galileo(1046, 7, 1220));
  ASSERT_EQ(navigation.kepler.size(), 2U);
  for (const auto& e : navigation.kepler) {
    const bool inav = (e.sources & 1) != 0;
    EXPECT_EQ(e.sources, inav ? 517 : 258);
    EXPECT_EQ(e.health, inav ? 2 << 1 | 1 << 6 | 1 << 7 : 1 << 3 | 2 << 4);
    EXPECT_EQ(e.toe, gps_at(36'000.0));
    EXPECT_EQ(e.toc, gps_at(36'060.0));
    EXPECT_EQ(e.issue, 77);
    EXPECT_NEAR(e.accuracy_m, 3.12, 1e-12);
    EXPECT_EQ(e.group_delay[0], test::scaled(-33, -32));
    EXPECT_EQ(e.group_delay[1], inav ? test::scaled(44, -32) : 0.0);
    EXPECT_EQ(e.clock, (std::array{test::scaled(-700'000, -34), test::scaled(800, -46), test::scaled(-9, -59)}));
    expect_orbit(e, 5440.6);
  }
}

TEST(RtcmEphemerides, OfGlonassHaveThePlaceAndTheDayOfMoscow) {
  // The 51st quarter of the day is 12:45 in Moscow, 09:45 UTC.
  const auto navigation = ephemerides_of(in_week(test::rtcm_1020(9, -2, 51) + test::rtcm_1020(10, 3, 51, 1)));
  ASSERT_EQ(navigation.tabulated.size(), 2U);
  const auto& e = navigation.tabulated[0];
  EXPECT_EQ(record::to_string(e.satellite), "R09");
  EXPECT_EQ(e.t, gps_at(35'100.0 + 18.0));
  EXPECT_EQ(e.channel, -2);
  EXPECT_EQ(e.health, 0);
  EXPECT_EQ(navigation.tabulated[1].health, 1);
  EXPECT_EQ(e.clock_bias, -test::scaled(123'456, -30));
  EXPECT_EQ(e.clock_drift, test::scaled(-5, -40));
  EXPECT_EQ(e.r_e, Eigen::Vector3d(test::scaled(30e9, -11), test::scaled(-20e9, -11), test::scaled(37e9, -11)));
  EXPECT_EQ(e.v_e, Eigen::Vector3d(test::scaled(-1.5e9, -20), test::scaled(2e9, -20), test::scaled(-0.5e9, -20)));
  EXPECT_EQ(e.a_e, Eigen::Vector3d(test::scaled(-3e3, -30), test::scaled(2e3, -30), test::scaled(-1e3, -30)));
}

TEST(RtcmEphemerides, OfAnotherWeekOrTooShortAreLeftOut) {
  const auto navigation =
      ephemerides_of(in_week(msm(Msm{}) + test::rtcm_1019(8, kShortWeek - 3) +
                             test::rtcm_frame(BitString().put(1046, 12).put(0, 200)) + test::rtcm_1019(0, kShortWeek)));
  EXPECT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 3);
}

TEST(RtcmFiles, AreFoundAmongOtherMessagesAndDamage) {
  const std::string epoch = msm(Msm{}), next = msm(Msm{.epoch = 36'001'000, .cells = {{}}});
  std::string spoiled = next;
  spoiled[20] = static_cast<char>(spoiled[20] ^ 4);
  const std::string content = "ICY 200 OK\r\n\r\n" + in_week(epoch) + test::nmea("GNGGA,,,,,,0,00,99.99,,,,,,") +
                              test::ubx(0x01, 0x20, std::string(16, '\0')) + spoiled + next + test::rtcm3(1071, 40) +
                              test::rtcm3(1230, 8) + next.substr(0, 30);
  const auto recording = rtcm_observations_of(content);
  EXPECT_EQ(recording.epochs.size(), 2U);
  EXPECT_EQ(test::count_of(recording.events, "message_checksum"), 1);
  EXPECT_EQ(test::count_of(recording.events, "message_cut_off"), 1);
  EXPECT_EQ(test::count_of(recording.events, "messages_not_read"), 4);
  const Files files;
  const auto contents = read_contents(files.put("log.bin", content));
  EXPECT_EQ(contents.format, "RTCM 3 of base stations and casters");
  EXPECT_EQ(contents.navigation->kepler.size(), 1U);
}

TEST(RtcmFiles, WithMasksThatPromiseMoreAreLeftOut) {
  BitString b;
  b.put(1077, 12).put(12, 12).put(36'000'000, 30).put(0, 19).put(-1, 64).put(-1, 32).put(0, 100);
  BitString few;
  few.put(1077, 12).put(12, 12).put(36'000'000, 30).put(0, 19).put(255, 64).put(255, 32).put(-1, 64);
  const auto recording = rtcm_observations_of(in_week(msm(Msm{}) + test::rtcm_frame(b) + test::rtcm_frame(few)));
  EXPECT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(test::count_of(recording.events, "rtcm_spoiled"), 2);
}

TEST(RtcmFiles, WithoutObservationsOrEphemeridesAreRefused) {
  const Files files;
  files.put("base.rtcm3", test::rtcm3(1230, 8));
  EXPECT_NE(test::refusal([&] { (void)read_observations(files.path("base.rtcm3")); }).find("MSM4"), std::string::npos);
  EXPECT_NE(test::refusal([&] { (void)read_navigation(files.path("base.rtcm3")); }).find("1019"), std::string::npos);
}

}  // namespace
}  // namespace coast::io
