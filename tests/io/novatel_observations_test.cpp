// Ranges and ephemerides in NovAtel logs of known content.

#include <gtest/gtest.h>

#include <cmath>

#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/navigation_messages.hpp"
#include "io/novatel_messages.hpp"

namespace coast::io {
namespace {

using record::Observation;
using test::Files;
using test::NovAtelBody;
using test::NovAtelHead;

constexpr double kNovAtelTestLight = 299792458.0;

/// Phase lock, parity known, code lock; system and signal.
std::uint32_t novatel_tracking(unsigned system, unsigned signal, std::uint32_t flags = 7U << 10) {
  return flags | system << 16 | signal << 21;
}

struct RangeOf {
  unsigned prn = 5, frequency = 0;
  double code = 21'000'000.125, adr = -110'000'000.25;
  float doppler = -1234.5F, cn0 = 45.5F, lock = 100.0F;
  std::uint32_t status = novatel_tracking(0, 0);
};

NovAtelBody range_body(const std::vector<RangeOf>& ranges) {
  NovAtelBody b;
  b.u32(static_cast<std::uint32_t>(ranges.size()));
  for (const RangeOf& r : ranges) {
    b.u16(r.prn).u16(r.frequency).f64(r.code).f32(0.1F).f64(r.adr).f32(0.01F);
    b.f32(r.doppler).f32(r.cn0).f32(r.lock).hex32(r.status);
  }
  return b;
}

record::ObservationRecording novatel_observations_of(const std::string& content) {
  const Files files;
  return read_observations(files.put("log.gps", content));
}

const Observation* novatel_signal_at(const record::ObservationEpoch& epoch, const std::string& satellite,
                                     record::Signal signal) {
  for (const Observation& o : epoch.observations)
    if (record::to_string(o.satellite) == satellite && o.signal == signal) return &o;
  return nullptr;
}

TEST(NovAtelRange, HasTheSignalsOfRinexAndTheSignOfItsPhase) {
  const std::vector<RangeOf> all = {
      {},
      {.prn = 5, .status = novatel_tracking(0, 17)},
      {.prn = 5, .status = novatel_tracking(0, 9)},
      {.prn = 45, .frequency = 13, .status = novatel_tracking(1, 1)},
      {.prn = 133, .status = novatel_tracking(2, 0)},
      {.prn = 11, .status = novatel_tracking(3, 17)},
      {.prn = 30, .status = novatel_tracking(4, 4)},
      {.prn = 195, .status = novatel_tracking(5, 14)},
      {.prn = 3, .status = novatel_tracking(6, 0, 5U << 10)},
      {.prn = 7, .status = novatel_tracking(0, 0, 1U << 12)},
      {.prn = 70, .status = novatel_tracking(0, 0)},
      {.prn = 8, .status = novatel_tracking(7, 19)},
  };
  for (const std::string& content :
       {test::novatel_binary(43, range_body(all)), test::novatel_ascii("RANGEA", range_body(all))}) {
    const auto recording = novatel_observations_of(content);
    ASSERT_EQ(recording.epochs.size(), 1U);
    const auto& epoch = recording.epochs[0];
    EXPECT_EQ(epoch.t, geo::GpsTime::from_week(2200, 300'000.0));
    EXPECT_EQ(epoch.observations.size(), 10U);
    for (const auto& [satellite, signal] : std::vector<std::pair<const char*, record::Signal>>{{"G05", {'1', 'C'}},
                                                                                               {"G05", {'2', 'S'}},
                                                                                               {"G05", {'2', 'W'}},
                                                                                               {"R08", {'2', 'C'}},
                                                                                               {"S33", {'1', 'C'}},
                                                                                               {"E11", {'7', 'Q'}},
                                                                                               {"C30", {'2', 'I'}},
                                                                                               {"J03", {'5', 'Q'}},
                                                                                               {"I03", {'5', 'A'}}}) {
      const Observation* o = novatel_signal_at(epoch, satellite, signal);
      ASSERT_NE(o, nullptr) << satellite;
      EXPECT_EQ(o->code_m, 21'000'000.125);
      EXPECT_EQ(o->phase_cycles, 110'000'000.25);
      EXPECT_EQ(o->doppler_hz, -1234.5);
      EXPECT_EQ(o->cn0_dbhz, 45.5);
      EXPECT_EQ(o->half_cycle, satellite[0] == 'I');
    }
    const Observation* code_only = novatel_signal_at(epoch, "G07", {'1', 'C'});
    ASSERT_NE(code_only, nullptr);
    EXPECT_TRUE(code_only->code_m && !code_only->phase_cycles);
    EXPECT_EQ(recording.glonass_channels.at(8), 6);
  }
}

TEST(NovAtelRange, LosesLockWhereTheTimeOfLockDoesNotGrowWithTime) {
  struct Step {
    double t;
    float lock;
    bool half_cycle_added, lost;
  };
  const std::vector<Step> steps = {{0.0, 10.0F, false, true}, {1.0, 11.0F, false, false}, {2.0, 0.5F, false, true},
                                   {3.0, 1.5F, false, false}, {6.0, 4.5F, false, false},  {9.0, 2.0F, false, true},
                                   {10.0, 3.0F, true, true},  {11.0, 4.0F, true, false},  {11.5, 4.4F, true, true},
                                   {12.5, 5.36F, true, false}};
  std::string content;
  for (const Step& step : steps) {
    RangeOf range;
    range.lock = step.lock;
    if (step.half_cycle_added) range.status |= 1U << 28;
    content += test::novatel_binary(43, range_body({range}), {2200, 300'000.0 + step.t});
  }
  const auto recording = novatel_observations_of(content);
  ASSERT_EQ(recording.epochs.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(recording.epochs[i].observations[0].lost_lock, steps[i].lost) << i;
}

TEST(NovAtelRange, OfCoarseTimeOrOfTheSecondAntennaIsLeftOut) {
  const NovAtelHead coarse{2200, 299'999.0, 100, "COARSE"};
  const NovAtelHead second{2200, 300'000.0, 180, "FINESTEERING", 1};
  const auto recording = novatel_observations_of(
      test::novatel_binary(43, range_body({RangeOf{}}), coarse) + test::novatel_binary(43, range_body({RangeOf{}})) +
      test::novatel_binary(43, range_body({RangeOf{.prn = 9}}), second) +
      test::novatel_ascii("RANGEA_1", range_body({RangeOf{.prn = 9}}), {2200, 300'001.0}));
  ASSERT_EQ(recording.epochs.size(), 1U);
  EXPECT_EQ(recording.epochs[0].observations.size(), 1U);
}

TEST(NovAtelRange, WhoseNumberContradictsItsLengthIsLeftOut) {
  NovAtelBody more = range_body({RangeOf{}});
  more.binary[0] = 2;
  const auto recording = novatel_observations_of(test::novatel_binary(43, more) +
                                                 test::novatel_binary(43, range_body({RangeOf{}}), {2200, 300'001.0}));
  EXPECT_EQ(recording.epochs.size(), 1U);
  EXPECT_TRUE(std::ranges::any_of(recording.events, [](const auto& e) { return e.kind == "range_spoiled" && e.count == 1; }));
}

/// Bits from the lowest on.
class LowFirst {
 public:
  LowFirst& put(std::int64_t value, int count) {
    for (int i = 0; i < count; ++i) bits_.push_back((value >> i & 1) != 0);
    return *this;
  }
  [[nodiscard]] std::string str() const {
    std::string bytes((bits_.size() + 7) / 8, '\0');
    for (std::size_t i = 0; i < bits_.size(); ++i)
      if (bits_[i]) bytes[i / 8] = static_cast<char>(static_cast<unsigned char>(bytes[i / 8]) | 1U << i % 8);
    return bytes;
  }

 private:
  std::vector<bool> bits_;
};

TEST(NovAtelRange, CompressedHasItsPhaseNearestToTheCode) {
  const double code = 21'000'000.0 + 3.0 / 128.0;
  const double cycles = code * 1575.42e6 / kNovAtelTestLight + 1234.25;  // in steps of 1/256
  const double phase = std::floor(cycles * 256.0) / 256.0;
  const double rolled = -std::remainder(phase, 8388608.0);
  LowFirst record;
  record.put(novatel_tracking(0, 0), 32).put(-1234 * 256 - 128, 28).put(21'000'000LL * 128 + 3, 36);
  record.put(static_cast<std::int64_t>(rolled * 256.0), 32)
      .put(0, 8)
      .put(5, 8)
      .put(100 * 32, 21)
      .put(25, 5)
      .put(0, 6)
      .put(0, 16);
  NovAtelBody body;
  body.u32(1).bytes(record.str());
  for (const std::string& content : {test::novatel_binary(140, body), test::novatel_ascii("RANGECMPA", body)}) {
    const auto recording = novatel_observations_of(content);
    const Observation& o = recording.epochs.at(0).observations.at(0);
    EXPECT_EQ(o.code_m, code);
    EXPECT_EQ(o.phase_cycles, phase);
    EXPECT_EQ(o.doppler_hz, -1234.5);
    EXPECT_EQ(o.cn0_dbhz, 45.0);
  }
}

TEST(NovAtelRange, CompressedBySatelliteHasItsSignals) {
  // Slot 8 of GLONASS on channel 6: L1 and L2.
  LowFirst bits;
  bits.put(3, 8).put(8, 8);
  bits.put(13, 4).put(1, 5).put(0, 1).put(21'000'000, 29).put(-2000, 21).put(2, 4);
  bits.put(1, 5).put(7, 3).put(5000, 17).put(0, 4).put(1, 1).put(0, 2);
  bits.put(30, 5).put(0, 8).put(64, 14).put(2048, 20).put(-128, 17);
  bits.put(3, 5).put(5, 3).put(131071, 17).put(0, 4).put(0, 1).put(1, 1).put(0, 1);
  bits.put(20, 5).put(0, 8).put(128, 14).put(4096, 20).put(0, 17);
  NovAtelBody body;
  body.u32(static_cast<std::uint32_t>(bits.str().size())).bytes(bits.str());
  const auto recording = novatel_observations_of(test::novatel_binary(1273, body));
  const auto& epoch = recording.epochs.at(0);
  ASSERT_EQ(epoch.observations.size(), 2U);
  const Observation* first = novatel_signal_at(epoch, "R08", {'1', 'C'});
  const Observation* second = novatel_signal_at(epoch, "R08", {'2', 'C'});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->code_m, 21'000'000.5);
  EXPECT_EQ(second->code_m, 21'000'001.0);
  EXPECT_NEAR(*first->phase_cycles, 21'000'001.0 * (1602.0e6 + 6 * 562.5e3) / kNovAtelTestLight, 1e-6);
  EXPECT_NEAR(*second->phase_cycles, 21'000'002.0 * (1246.0e6 + 6 * 437.5e3) / kNovAtelTestLight, 1e-6);
  EXPECT_NEAR(*first->doppler_hz, -2000.5, 1e-9);
  EXPECT_NEAR(*second->doppler_hz, -2000.0 * 7.0 / 9.0, 1e-9);
  EXPECT_EQ(first->cn0_dbhz, 50.0);
  EXPECT_FALSE(first->half_cycle);
  EXPECT_TRUE(second->half_cycle);
  EXPECT_EQ(recording.glonass_channels.at(8), 6);
}

/// Two signals of G05 at a whole second, then a quarter after it as differences.
TEST(NovAtelRange, CompressedByDifferencesFollowsTheRate) {
  const auto masks = [](LowFirst& b) -> LowFirst& { return b.put(1, 16).put(1 << 4, 64).put(1 << 1 | 1 << 5, 16).put(3, 2); };
  const auto head = [](LowFirst& b, int lock) -> LowFirst& {
    return b.put(1, 1).put(0, 1).put(900, 11).put(lock, 4).put(0, 8);
  };
  LowFirst whole, later;
  masks(whole).put(0, 1).put(2, 3);
  head(whole, 10).put(42'000'000'000, 37).put(-10'000, 23).put(-5'000'000, 26);  // 21000 km, -1 m, -500 m/s
  head(whole, 10).put(2'000, 20).put(20'000, 23).put(100, 14);
  masks(later).put(1, 1).put(2, 3);
  head(later, 10).put(40, 19).put(-30, 16).put(10, 18);
  head(later, 10).put(0, 19).put(0, 16).put(0, 14);
  NovAtelBody one, two;
  one.u32(static_cast<std::uint32_t>(whole.str().size())).bytes(whole.str());
  two.u32(static_cast<std::uint32_t>(later.str().size())).bytes(later.str());
  const auto recording =
      novatel_observations_of(test::novatel_binary(2050, two, {2200, 299'999.25}) + test::novatel_binary(2050, one) +
                              test::novatel_ascii("RANGECMP4A", two, {2200, 300'000.25}));
  ASSERT_EQ(recording.epochs.size(), 2U);
  const double l1 = 1575.42e6 / kNovAtelTestLight, l2 = 1227.6e6 / kNovAtelTestLight;
  const auto& a = recording.epochs[0].observations;
  const auto& b = recording.epochs[1].observations;
  ASSERT_EQ(a.size(), 2U);
  ASSERT_EQ(b.size(), 2U);
  EXPECT_EQ(a[0].signal, (record::Signal{'1', 'C'}));
  EXPECT_EQ(a[1].signal, (record::Signal{'2', 'S'}));
  EXPECT_NEAR(*a[0].code_m, 21'000'000.0, 1e-6);
  EXPECT_NEAR(*a[0].phase_cycles, 20'999'999.0 * l1, 1e-5);
  EXPECT_NEAR(*a[0].doppler_hz, 500.0 * l1, 1e-6);
  EXPECT_NEAR(*a[1].code_m, 21'000'001.0, 1e-6);
  EXPECT_NEAR(*a[1].phase_cycles, 21'000'003.0 * l2, 1e-5);
  EXPECT_NEAR(*a[1].doppler_hz, 499.99 * l2, 1e-6);
  EXPECT_NEAR(*b[0].code_m, 21'000'000.0 - 125.0 + 0.02, 1e-6);
  EXPECT_NEAR(*b[0].phase_cycles, (20'999'999.0 - 125.0 - 0.003) * l1, 1e-5);
  EXPECT_NEAR(*b[0].doppler_hz, 499.999 * l1, 1e-6);
  EXPECT_NEAR(*b[1].code_m, 21'000'001.0 - 0.25 * 499.99, 1e-6);
  EXPECT_FALSE(b[0].lost_lock);
  EXPECT_TRUE(std::ranges::any_of(recording.events, [](const auto& e) { return e.kind == "range_empty" && e.count == 1; }));
}

// Ephemerides

record::NavigationRecording novatel_navigation_of(const std::string& content) {
  const Files files;
  return read_navigation(files.put("log.gps", content));
}

/// NumberedFields that tell fields apart: 1e-3, 2e-3, ..
class NumberedFields {
 public:
  explicit NumberedFields(NovAtelBody& body) : body_(body) {}
  void put(int count) {
    for (int i = 0; i < count; ++i) body_.f64(1e-3 * ++number_);
  }
  void put(double value) {
    ++number_;
    body_.f64(value);
  }

 private:
  NovAtelBody& body_;
  int number_ = 0;
};

TEST(NovAtelNavigation, HasTheEphemerisOfGps) {
  NovAtelBody b;
  b.u32(5).f64(299'994.0).u32(0).u32(68).u32(68).u32(2200).u32(2200).f64(302'400.0);
  NumberedFields n(b);
  n.put(2.6559425980e+07);
  n.put(14);
  b.u32(68).f64(302'384.0);
  n.put(4);
  b.word("TRUE", 1).f64(1.458e-4).f64(4.0);
  for (const std::string& content : {test::novatel_binary(7, b), test::novatel_ascii("GPSEPHEMA", b)}) {
    const auto navigation = novatel_navigation_of(content);
    ASSERT_EQ(navigation.kepler.size(), 1U);
    const auto& e = navigation.kepler[0];
    EXPECT_EQ(record::to_string(e.satellite), "G05");
    EXPECT_EQ(e.toe, geo::GpsTime::from_week(2200, 302'400.0));
    EXPECT_EQ(e.toc, geo::GpsTime::from_week(2200, 302'384.0));
    EXPECT_EQ(e.sqrt_a, std::sqrt(2.6559425980e+07));
    const std::vector<double> found = {e.delta_n, e.mean_anomaly, e.eccentricity, e.perigee, e.cuc,         e.cus,
                                       e.crc,     e.crs,          e.cic,          e.cis,     e.inclination, e.inclination_rate,
                                       e.node,    e.node_rate};
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], 1e-3 * static_cast<double>(i + 2), 1e-15) << i;
    EXPECT_EQ(e.accuracy_m, 2.0);
    EXPECT_EQ(e.issue, 68);
    EXPECT_EQ(e.health, 0);
  }
}

TEST(NovAtelNavigation, HasTheStateOfGlonassAndTheClockOfRinex) {
  NovAtelBody b;
  b.u16(51).u16(0).u8(1).u8(80).u16(2200).u32(301'518'000).u32(10782).u16(573).u8(0).u8(0).u32(95).u32(0);
  b.f64(-2.3917966796875e+07).f64(4.8163881835937e+06).f64(7.42585107421875e+06);
  b.f64(-1.0062713623e+03).f64(1.8321990966e+02).f64(-3.3695755004e+03).f64(1.86e-06).f64(-9.3e-07).f64(0.0);
  b.f64(-6.69e-05).f64(5.58e-09).f64(1.5e-12).u32(84600).u32(3).u32(2).u32(0).u32(13);
  for (const std::string& content : {test::novatel_binary(723, b), test::novatel_ascii("GLOEPHEMERISA", b)}) {
    const auto navigation = novatel_navigation_of(content);
    ASSERT_EQ(navigation.tabulated.size(), 1U);
    const auto& e = navigation.tabulated[0];
    EXPECT_EQ(record::to_string(e.satellite), "R14");
    EXPECT_EQ(e.channel, -7);
    EXPECT_EQ(e.t, geo::GpsTime::from_week(2200, 301'518.0));
    EXPECT_EQ(e.r_e.x(), -2.3917966796875e+07);
    EXPECT_EQ(e.v_e.z(), -3.3695755004e+03);
    EXPECT_EQ(e.a_e.y(), -9.3e-07);
    EXPECT_EQ(e.clock_bias, 6.69e-05);
    EXPECT_EQ(e.clock_drift, 1.5e-12);
  }
}

TEST(NovAtelNavigation, HasBothMessagesOfGalileo) {
  NovAtelBody b;
  b.u32(11).word("TRUE", 1).word("TRUE", 1).u8(0).u8(1).u8(0).u8(0).u8(0).u8(0).u8(107).u8(0).u32(77).u32(301'800).f64(5440.6);
  for (int i = 0; i < 14; ++i) b.f64(1e-3 * i);
  b.u32(301'800).f64(1e-4).f64(2e-12).f64(0.0).u32(301'800).f64(1.5e-4).f64(2e-12).f64(0.0).f64(-3e-9).f64(-4e-9);
  const auto navigation = novatel_navigation_of(test::novatel_binary(1122, b));
  ASSERT_EQ(navigation.kepler.size(), 2U);
  for (const auto& e : navigation.kepler) {
    EXPECT_EQ(record::to_string(e.satellite), "E11");
    EXPECT_EQ(e.issue, 77);
    EXPECT_NEAR(e.accuracy_m, 3.12, 1e-12);
    EXPECT_EQ(e.health, 1 << 4);
    const bool inav = e.sources == 517;
    EXPECT_EQ(e.clock[0], inav ? 1.5e-4 : 1e-4);
    EXPECT_EQ(e.group_delay[0], -3e-9);
    EXPECT_EQ(e.group_delay[1], inav ? -4e-9 : 0.0);
  }
}

/// An example of the manual, of two satellites of one plane: their nodes are the same to 0.2 deg.
TEST(NovAtelNavigation, OfTheManualHasOnePlane) {
  const std::string one =
      "#GALINAVEPHEMERISA,USB1,1,54.0,SATTIME,2209,504514.000,02000020,dbe9,16809;34,0,0,0,0,0,0,0,0,69,107,3,502200,502200,"
      "-1.35918661e+00,2.4115e-09,2.855090424e-04,5.44061144e+03,9.978304990e-01,-5.8931e-11,2.72810277e+00,1.63000994e+00,"
      "-5.1241420e-09,-4.7926e-06,1.3456e-05,6.991e+01,-1.037e+02,-3.9116e-08,-3.5390e-08,-5.168783828e-04,-1.961098e-12,0.0,"
      "4.657e-09,5.588e-09*3526c71f\r\n";
  const auto navigation = novatel_navigation_of(one);
  ASSERT_EQ(navigation.kepler.size(), 1U);
  const auto& e = navigation.kepler[0];
  EXPECT_EQ(record::to_string(e.satellite), "E34");
  EXPECT_EQ(e.sqrt_a, 5.44061144e+03);
  EXPECT_EQ(e.node, 2.72810277);
  EXPECT_EQ(e.inclination, 0.997830499);
  EXPECT_EQ(e.clock[0], -5.168783828e-04);
  EXPECT_EQ(e.group_delay[1], 5.588e-09);
  EXPECT_EQ(e.issue, 69);
}

TEST(NovAtelNavigation, OfBeidouIsInGpsTime) {
  NovAtelBody b;
  b.u32(30).u32(2200 - 1356).f64(2.0).u32(0).f64(1e-9).f64(2e-9).u32(1).u32(298'800).f64(1e-4).f64(0.0).f64(0.0);
  b.u32(1).u32(298'800).f64(5282.6).f64(1e-3).f64(0.3);
  for (int i = 0; i < 12; ++i) b.f64(1e-3 * i);
  const auto navigation = novatel_navigation_of(test::novatel_binary(1696, b));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(record::to_string(navigation.kepler[0].satellite), "C30");
  EXPECT_EQ(navigation.kepler[0].toe, geo::GpsTime::from_week(2200, 298'814.0));
  EXPECT_EQ(navigation.kepler[0].group_delay[1], 2e-9);
}

/// Subframes 1 to 3 without parity, as RAWEPHEM has them, and the ionosphere of IONUTC.
TEST(NovAtelNavigation, HasSubframesAsReceived) {
  const auto subframe = [](int number, const test::BitString& words) {
    test::BitString data;
    data.put(0x8b, 8).put(0, 16).put(50'000, 17).put(0, 2).put(number, 3).put(0, 2).put(words);
    std::string bytes;
    for (std::size_t at = 0; at < 240; at += 8) bytes += static_cast<char>(data.number(at, 8));
    return bytes;
  };
  test::BitString one, two, three;
  one.put(2200 % 1024, 10).put(1, 2).put(0, 4).put(0, 6).put(0, 2).put(0, 24 * 3 + 16).put(-5, 8);
  one.put(68, 8).put(302'400 / 16, 16).put(0, 8).put(-3, 16).put(1000, 22).put(0, 2);
  two.put(68, 8).put(32, 16).put(100, 16).put(1 << 30, 32).put(7, 16).put(1 << 26, 32).put(8, 16);
  two.put(static_cast<std::int64_t>(5153.0 * (1 << 19)), 32).put(302'400 / 16, 16).put(0, 8);
  three.put(1, 16).put(1 << 28, 32).put(2, 16).put(1 << 29, 32).put(64, 16).put(-(1 << 27), 32).put(-100, 24).put(68, 8);
  three.put(50, 14).put(0, 2);
  NovAtelBody raw, ionosphere;
  raw.u32(5).u32(2200).u32(302'400).bytes(subframe(1, one)).bytes(subframe(2, two)).bytes(subframe(3, three));
  for (int i = 0; i < 8; ++i) ionosphere.f64(i < 4 ? 1e-8 * (i + 1) : 1e4 * (i + 1));
  ionosphere.u32(2200).u32(0).f64(0.0).f64(0.0).u32(0).u32(0).i32(18).i32(18).u32(0);
  const std::string binary = test::novatel_binary(41, raw) + test::novatel_binary(8, ionosphere);
  const std::string ascii = test::novatel_ascii("RAWEPHEMA", raw) + test::novatel_ascii("IONUTCA", ionosphere);
  for (const std::string& content : {binary, ascii}) {
    const auto navigation = novatel_navigation_of(content);
    ASSERT_EQ(navigation.kepler.size(), 1U);
    const auto& e = navigation.kepler[0];
    EXPECT_EQ(e.toe, geo::GpsTime::from_week(2200, 302'400.0));
    EXPECT_EQ(e.sqrt_a, 5153.0);
    EXPECT_EQ(e.crs, 1.0);
    EXPECT_EQ(e.crc, 2.0);
    EXPECT_EQ(e.clock[0], std::ldexp(1000.0, -31));
    ASSERT_TRUE(navigation.gps_ionosphere);
    EXPECT_DOUBLE_EQ(navigation.gps_ionosphere->alpha[2], 3e-8);
    EXPECT_DOUBLE_EQ(navigation.gps_ionosphere->beta[3], 8e4);
  }
}

TEST(NovAtelNavigation, ThatIsNoOrbitIsLeftOut) {
  NovAtelBody b;
  b.u32(5).f64(0.0).u32(0).u32(68).u32(68).u32(2200).u32(2200).f64(std::nan(""));
  for (int i = 0; i < 15; ++i) b.f64(std::nan(""));
  b.u32(68).f64(1e9);
  for (int i = 0; i < 4; ++i) b.f64(1.0);
  b.word("TRUE", 1).f64(1.0).f64(-1.0);
  const Files files;
  EXPECT_NE(test::refusal([&] {
              (void)read_navigation(files.put("log.gps", test::novatel_binary(7, b)));
            }).find("without a whole ephemeris"),
            std::string::npos);
}

}  // namespace
}  // namespace coast::io
