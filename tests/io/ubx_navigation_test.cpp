// Ephemerides out of UBX-RXM-SFRBX: numbers that were put into the bits come out.

#include <gtest/gtest.h>

#include <cmath>

#include "coast/geo/units.hpp"
#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/navigation_messages.hpp"
#include "io/ubx_messages.hpp"

namespace coast::io {
namespace {

using test::BitString;
using test::Files;
using test::glonass_string;
using test::inav_page;
using test::lnav_subframe;
using test::LnavForm;
using test::sfrbx;

constexpr int kMessageWeek = 2244;
constexpr double kMessageSecond = 36000.0;

/// A time before the messages, so that the week is known.
std::string timed(const std::string& messages, double sow = kMessageSecond, unsigned week = kMessageWeek) {
  return test::rawx(week, sow, {}) + messages;
}

record::NavigationRecording navigation_of(const std::string& content) {
  const Files files;
  return read_navigation(std::vector{files.put("nav.ubx", content)});
}

/// Unscaled numbers of an orbit that GPS could have; signs on both sides.
struct LnavNumbers {
  int week = kMessageWeek % 1024, iodc = 0x2a5, iode2 = 0xa5, iode3 = 0xa5;
  std::int64_t sqrt_a = std::llround(5153.65 * (1 << 19)), eccentricity = 104'857'600, toe = 36000 / 16, health = 0;
};

std::string lnav(unsigned gnss, unsigned sv, const LnavNumbers& n, LnavForm form = LnavForm::kWordInverted) {
  BitString one, two, three;
  one.put(n.week, 10).put(1, 2).put(2, 4).put(n.health, 6).put(n.iodc >> 8, 2);
  one.put(0, 24 + 24 + 24 + 16).put(-11, 8).put(n.iodc & 0xff, 8).put(36000 / 16, 16);
  one.put(-1, 8).put(-1234, 16).put(-345'678, 22).put(0, 2);
  two.put(n.iode2, 8).put(-1100, 16).put(12'345, 16).put(-1'717'986'918, 32).put(-222, 16).put(n.eccentricity, 32);
  two.put(3333, 16).put(n.sqrt_a, 32).put(n.toe, 16).put(0, 6).put(0, 2);
  three.put(-44, 16).put(-1'000'000'001, 32).put(55, 16).put(657'000'000, 32).put(7001, 16).put(999'999'999, 32);
  three.put(-21'000, 24).put(n.iode3, 8).put(-777, 14).put(0, 2);
  return sfrbx(gnss, sv, 0, 0, lnav_subframe(1, one, form)) + sfrbx(gnss, sv, 0, 0, lnav_subframe(2, two, form)) +
         sfrbx(gnss, sv, 0, 0, lnav_subframe(3, three, form));
}

void expect_lnav(const record::KeplerEphemeris& e) {
  const auto scaled = [](double value, int exponent) { return std::ldexp(value, exponent); };
  const auto angle = [](double value, int exponent) { return geo::kPi * std::ldexp(value, exponent); };
  const geo::GpsTime t = geo::GpsTime::from_week(kMessageWeek, kMessageSecond);
  EXPECT_EQ(e.toe, t);
  EXPECT_EQ(e.toc, t);
  EXPECT_EQ(e.issue, 0xa5);
  EXPECT_EQ(e.accuracy_m, 4.0);
  EXPECT_EQ(e.sources, 1);
  EXPECT_EQ(e.group_delay[0], scaled(-11, -31));
  EXPECT_EQ(e.clock[0], scaled(-345'678, -31));
  EXPECT_EQ(e.clock[1], scaled(-1234, -43));
  EXPECT_EQ(e.clock[2], scaled(-1, -55));
  EXPECT_EQ(e.crs, scaled(-1100, -5));
  EXPECT_EQ(e.delta_n, angle(12'345, -43));
  EXPECT_EQ(e.mean_anomaly, angle(-1'717'986'918, -31));
  EXPECT_EQ(e.cuc, scaled(-222, -29));
  EXPECT_EQ(e.eccentricity, scaled(104'857'600, -33));
  EXPECT_EQ(e.cus, scaled(3333, -29));
  EXPECT_NEAR(e.sqrt_a, 5153.65, 1e-6);
  EXPECT_EQ(e.cic, scaled(-44, -29));
  EXPECT_EQ(e.node, angle(-1'000'000'001, -31));
  EXPECT_EQ(e.cis, scaled(55, -29));
  EXPECT_EQ(e.inclination, angle(657'000'000, -31));
  EXPECT_EQ(e.crc, scaled(7001, -5));
  EXPECT_EQ(e.perigee, angle(999'999'999, -31));
  EXPECT_EQ(e.node_rate, angle(-21'000, -43));
  EXPECT_EQ(e.inclination_rate, angle(-777, -43));
}

TEST(Lnav, OfGpsAndQzssHasItsNumbersInBothFormsOfParity) {
  for (const LnavForm form : {LnavForm::kWordInverted, LnavForm::kDataInverted}) {
    const auto navigation = navigation_of(timed(lnav(0, 7, {}, form) + lnav(5, 2, {}, form) + lnav(0, 7, {}, form)));
    ASSERT_EQ(navigation.kepler.size(), 2U);
    EXPECT_EQ(record::to_string(navigation.kepler[0].satellite), "G07");
    EXPECT_EQ(record::to_string(navigation.kepler[1].satellite), "J02");
    for (const auto& e : navigation.kepler) expect_lnav(e);
    EXPECT_TRUE(navigation.events.empty());
  }
}

TEST(Lnav, OfDifferentIssuesIsNotMixed) {
  LnavNumbers torn, next;
  torn.iode3 = 0xa6;
  next.iodc = 0x2a6;
  next.iode2 = next.iode3 = 0xa6;
  const auto navigation = navigation_of(timed(lnav(0, 7, torn) + lnav(0, 7, next)));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(navigation.kepler[0].issue, 0xa6);
  torn.iode3 = 0xa5;
  torn.iodc = 0x2a4;
  const auto second = navigation_of(timed(lnav(0, 7, torn) + lnav(0, 8, next)));
  ASSERT_EQ(second.kepler.size(), 1U);
  EXPECT_EQ(second.kepler[0].satellite.number, 8);
}

TEST(Lnav, WithAWrongBitIsLeftOutAndCounted) {
  // Any bit of any word: parity finds it; the bits of the HOW that only the parity guards are among them.
  const std::string good = lnav(0, 7, {});
  const auto subframe = test::lnav_subframe(2, BitString().put(0, 192), LnavForm::kWordInverted);
  std::string spoiled;
  for (std::size_t word = 0; word < 10; ++word)
    for (int bit = 0; bit < 30; ++bit) {
      auto words = subframe;
      words[word] ^= 1U << bit;
      spoiled += sfrbx(0, 7, 0, 0, words);
    }
  const auto navigation = navigation_of(timed(good + spoiled));
  EXPECT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 300);
}

TEST(Lnav, OfAnotherWeekOrAnImpossibleOrbitIsLeftOut) {
  LnavNumbers other, impossible, week_before;
  other.week = 5;
  impossible.sqrt_a = 1000 << 19;
  week_before.week -= 1;
  const auto navigation = navigation_of(timed(lnav(0, 7, {}) + lnav(0, 8, other) + lnav(0, 9, impossible)));
  EXPECT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 1);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_impossible"), 1);
  // Just after the turn of the week a message of the week before is one that was sent a moment ago.
  week_before.toe = 604'784 / 16;
  const auto turn = navigation_of(timed(lnav(0, 7, week_before), 5.0));
  ASSERT_EQ(turn.kepler.size(), 1U);
  EXPECT_EQ(turn.kepler[0].toe, geo::GpsTime::from_week(kMessageWeek - 1, 604'784.0));
}

TEST(Lnav, HasTheIonosphereOnPage18) {
  BitString page;
  page.put(1, 2).put(56, 6);
  for (const int value : {10, -20, 30, -40, 50, -60, 70, -80}) page.put(value, 8);
  page.put(0, 120);
  const auto navigation =
      navigation_of(timed(sfrbx(0, 7, 0, 0, lnav_subframe(4, page, LnavForm::kWordInverted)) + lnav(0, 7, {})));
  ASSERT_TRUE(navigation.gps_ionosphere);
  EXPECT_EQ(navigation.gps_ionosphere->alpha, (std::array{10 * 0x1p-30, -20 * 0x1p-27, 30 * 0x1p-24, -40 * 0x1p-24}));
  EXPECT_EQ(navigation.gps_ionosphere->beta, (std::array{50 * 0x1p11, -60 * 0x1p14, 70 * 0x1p16, -80 * 0x1p16}));
}

/// Words 1 to 5.
std::string inav(unsigned sv, unsigned signal, int issue = 77, int issue3 = 77, int number = -1) {
  const auto word = [&](int type, int iod) { return BitString().put(type, 6).put(iod, 10); };
  const std::int64_t root = std::llround(5440.6 * (1 << 19));
  const BitString one = word(1, issue).put(600, 14).put(-1'500'000'000, 32).put(1'000'000, 32).put(root, 32).put(0, 2);
  const BitString two = word(2, issue).put(-222'222'222, 32).put(670'000'000, 32).put(333, 32).put(-99, 14).put(0, 2);
  const BitString three =
      word(3, issue3).put(-15'000, 24).put(8000, 16).put(-1, 16).put(2, 16).put(-3, 16).put(4, 16).put(107, 8);
  const BitString four = word(4, issue)
                             .put(number < 0 ? static_cast<int>(sv) : number, 6)
                             .put(-5, 16)
                             .put(6, 16)
                             .put(601, 14)
                             .put(-700'000, 31)
                             .put(800, 21)
                             .put(-9, 6)
                             .put(0, 2);
  const BitString five = BitString()
                             .put(5, 6)
                             .put(0, 36 + 5)
                             .put(-10, 10)
                             .put(12, 10)
                             .put(1, 2)
                             .put(3, 2)
                             .put(0, 1)
                             .put(1, 1)
                             .put(kMessageWeek - 1024, 12)
                             .put(36'000, 20)
                             .put(0, 23);
  std::string messages;
  for (const BitString& bits : {one, two, three, four, five}) messages += sfrbx(2, sv, signal, 0, inav_page(bits));
  return messages;
}

TEST(Inav, HasItsNumbers) {
  const auto navigation = navigation_of(timed(inav(11, 1) + inav(11, 5) + inav(12, 5)));
  ASSERT_EQ(navigation.kepler.size(), 2U);
  const record::KeplerEphemeris& e = navigation.kepler[0];
  const auto angle = [](double value, int exponent) { return geo::kPi * std::ldexp(value, exponent); };
  EXPECT_EQ(record::to_string(e.satellite), "E11");
  EXPECT_EQ(e.toe, geo::GpsTime::from_week(kMessageWeek, 36'000.0));
  EXPECT_EQ(e.toc, geo::GpsTime::from_week(kMessageWeek, 36'060.0));
  EXPECT_EQ(e.issue, 77);
  EXPECT_EQ(e.sources, 517);
  EXPECT_EQ(e.mean_anomaly, angle(-1'500'000'000, -31));
  EXPECT_EQ(e.eccentricity, std::ldexp(1'000'000, -33));
  EXPECT_NEAR(e.sqrt_a, 5440.6, 1e-6);
  EXPECT_EQ(e.node, angle(-222'222'222, -31));
  EXPECT_EQ(e.inclination, angle(670'000'000, -31));
  EXPECT_EQ(e.perigee, angle(333, -31));
  EXPECT_EQ(e.inclination_rate, angle(-99, -43));
  EXPECT_EQ(e.node_rate, angle(-15'000, -43));
  EXPECT_EQ(e.delta_n, angle(8000, -43));
  EXPECT_EQ(e.cuc, -0x1p-29);
  EXPECT_EQ(e.cus, 0x1p-28);
  EXPECT_EQ(e.crc, -3 * 0x1p-5);
  EXPECT_EQ(e.crs, 0x1p-3);
  EXPECT_NEAR(e.accuracy_m, 3.12, 1e-12);  // index 107
  EXPECT_EQ(e.cic, -5 * 0x1p-29);
  EXPECT_EQ(e.cis, 6 * 0x1p-29);
  EXPECT_EQ(e.clock[0], -700'000 * 0x1p-34);
  EXPECT_EQ(e.clock[1], 800 * 0x1p-46);
  EXPECT_EQ(e.clock[2], -9 * 0x1p-59);
  EXPECT_EQ(e.group_delay[0], -10 * 0x1p-32);
  EXPECT_EQ(e.group_delay[1], 12 * 0x1p-32);
  EXPECT_EQ(e.health, 1 << 7 | 3 << 1 | 1);
}

TEST(Inav, ThatContradictsItselfIsLeftOut) {
  std::string wrong_crc = inav(13, 1);
  auto page = inav_page(BitString().put(1, 6).put(77, 10).put(0, 112));
  page[1] ^= 0x100U;
  const auto navigation =
      navigation_of(timed(inav(11, 1) + inav(12, 1, 77, 78) + inav(14, 1, 77, 77, 15) + sfrbx(2, 15, 1, 0, page) +
                          sfrbx(2, 15, 1, 0, inav_page(BitString().put(1, 6).put(0, 122), true)) +
                          sfrbx(2, 15, 1, 0, inav_page(BitString().put(0, 128)))));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 2);
}

/// Strings 1 to 4 of one frame; t_b in quarters of an hour of Moscow's day.
std::vector<std::vector<std::uint32_t>> glonass(unsigned slot, std::uint32_t frame, int tb) {
  const auto axis = [](BitString& string, int velocity, int acceleration, int position) {
    string.put_signed(velocity, 24).put_signed(acceleration, 5).put_signed(position, 27);
  };
  BitString one, two, three, four;
  one.put(0, 1).put(1, 4).put(0, 4).put(0, 12);
  axis(one, -1'500'000, 3, 20'000'000);
  two.put(0, 1).put(2, 4).put(0, 3).put(0, 1).put(tb, 7).put(0, 5);
  axis(two, 2'000'000, -2, -40'000'000);
  three.put(0, 1).put(3, 4).put(0, 1).put_signed(-7, 11).put(0, 1).put(0, 2).put(0, 1);
  axis(three, 2'500'000, 1, 25'000'000);
  four.put(0, 1).put(4, 4).put_signed(123'456, 22).put_signed(-1, 5).put(0, 5).put(0, 14).put(0, 1).put(2, 4).put(0, 3);
  four.put(8, 11).put(slot, 5).put(1, 2);
  std::vector<std::vector<std::uint32_t>> strings;
  for (const BitString& string : {one, two, three, four}) strings.push_back(glonass_string(string, frame));
  return strings;
}

std::string glonass_messages(unsigned slot, const std::vector<std::vector<std::uint32_t>>& strings) {
  std::string messages;
  for (const auto& words : strings) messages += sfrbx(6, slot, 0, 4, words);
  return messages;
}

TEST(GlonassStrings, HaveTheirNumbers) {
  // 10:00:00 of GPS time is 09:59:42 UTC; 12:45 in Moscow is 09:45:00 UTC.
  const auto navigation =
      navigation_of(timed(glonass_messages(5, glonass(5, 9, 51)) + glonass_messages(5, glonass(5, 10, 51))));
  ASSERT_EQ(navigation.tabulated.size(), 1U);
  const record::TabulatedEphemeris& e = navigation.tabulated[0];
  EXPECT_EQ(record::to_string(e.satellite), "R05");
  EXPECT_EQ(e.t, geo::GpsTime::from_utc({2023, 1, 8, 9, 45, 0.0}));
  EXPECT_EQ(e.channel, -3);
  EXPECT_EQ(e.health, 0);
  EXPECT_EQ(e.r_e, 1000.0 * Eigen::Vector3d(20'000'000, -40'000'000, 25'000'000) * 0x1p-11);
  EXPECT_EQ(e.v_e, 1000.0 * Eigen::Vector3d(-1'500'000, 2'000'000, 2'500'000) * 0x1p-20);
  EXPECT_LT((e.a_e - 1000.0 * Eigen::Vector3d(3, -2, 1) * 0x1p-30).norm(), 1e-18);
  EXPECT_EQ(e.clock_bias, -123'456 * 0x1p-30);
  EXPECT_EQ(e.clock_drift, -7 * 0x1p-40);
}

TEST(GlonassStrings, OfDifferentFramesAreNotMixed) {
  auto torn = glonass(5, 9, 51);
  torn[3].back() = 10;
  auto wrong = glonass(6, 9, 51);
  wrong[1][0] ^= 4U;
  auto other = glonass(7, 9, 51);
  const auto navigation = navigation_of(timed(glonass_messages(5, torn) + glonass_messages(6, wrong) +
                                              glonass_messages(8, other) + glonass_messages(9, glonass(9, 9, 51))));
  ASSERT_EQ(navigation.tabulated.size(), 1U);
  EXPECT_EQ(navigation.tabulated[0].satellite.number, 9);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 2);
}

/// A subframe from the preamble to the second of week.
BitString beidou_head(int subframe, int second) {
  return BitString().put(0b11100010010, 11).put(0, 4).put(subframe, 3).put(second, 20);
}

struct BeidouNumbers {
  int week = kMessageWeek - 1356, second = 35'982, toe = 36'000 / 8;
  std::int64_t root = std::llround(5282.6 * (1 << 19));
};

/// Subframes 1 to 3, six seconds apart.
std::vector<BitString> d1(const BeidouNumbers& n) {
  BitString one = beidou_head(1, n.second), two = beidou_head(2, n.second + 6), three = beidou_head(3, n.second + 12);
  one.put(1, 1).put(9, 5).put(2, 4).put(n.week, 13).put(36'000 / 8, 17).put(-56, 10).put(30, 10).put(0, 64);
  one.put(-3, 11).put(-345'678, 24).put(-1234, 22).put(17, 5);
  two.put(12'345, 16).put(-222, 18).put(-1'717'986'918, 32).put(1'048'576, 32).put(3333, 18).put(7001, 18).put(-1100, 18);
  two.put(n.root, 32).put(n.toe >> 15, 2);
  three.put(n.toe, 15).put(657'000'000, 32).put(-44, 18).put(-21'000, 24).put(55, 18).put(-777, 14);
  three.put(-1'000'000'001, 32).put(999'999'999, 32).put(0, 1);
  return {one, two, three};
}

/// Pages 1 to 10 of subframe 1, three seconds apart: fields are split between them where the ICD has a cut.
std::vector<BitString> d2(const BeidouNumbers& n) {
  std::vector<BitString> pages;
  for (int page = 1; page <= 10; ++page) pages.push_back(beidou_head(1, n.second + 3 * (page - 1)).put(page, 4));
  const auto page = [&](int number) -> BitString& { return pages[static_cast<std::size_t>(number - 1)]; };
  page(1).put(1, 1).put(9, 5).put(2, 4).put(n.week, 13).put(36'000 / 8, 17).put(-56, 10).put(30, 10);
  page(3).put(0, 38).put(-345'678, 24).put(-1234 >> 18, 4);
  page(4).put(-1234, 18).put(-3, 11).put(17, 5).put(12'345, 16).put(-222 >> 4, 14);
  page(5).put(-222, 4).put(-1'717'986'918, 32).put(3333, 18).put(1'048'576 >> 22, 10);
  page(6).put(1'048'576, 22).put(n.root, 32).put(-44 >> 8, 10);
  page(7).put(-44, 8).put(55, 18).put(n.toe, 17).put(657'000'000 >> 11, 21);
  page(8).put(657'000'000, 11).put(7001, 18).put(-1100, 18).put(-21'000 >> 5, 19);
  page(9).put(-21'000, 5).put(-1'000'000'001, 32).put(999'999'999 >> 5, 27);
  page(10).put(999'999'999, 5).put(-777, 14);
  for (BitString& one : pages) one.put(0, static_cast<int>(224 - one.size()));
  return pages;
}

std::string beidou(unsigned sv, unsigned signal, const std::vector<BitString>& parts,
                   test::BeidouForm form = test::BeidouForm::kHalves) {
  std::string messages;
  for (const BitString& part : parts) messages += sfrbx(3, sv, signal, 0, test::beidou_words(part, form));
  return messages;
}

void expect_beidou(const record::KeplerEphemeris& e) {
  const geo::GpsTime t = geo::GpsTime::from_week(kMessageWeek, kMessageSecond + 14.0);
  EXPECT_EQ(e.toe, t);
  EXPECT_EQ(e.toc, t);
  EXPECT_EQ(e.issue, 17);
  EXPECT_EQ(e.health, 1);
  EXPECT_EQ(e.accuracy_m, 4.0);
  EXPECT_NEAR(e.group_delay[0], -5.6e-9, 1e-22);
  EXPECT_NEAR(e.group_delay[1], 3.0e-9, 1e-22);
  EXPECT_EQ(e.clock, (std::array{test::scaled(-345'678, -33), test::scaled(-1234, -50), test::scaled(-3, -66)}));
  EXPECT_EQ(e.delta_n, test::angle(12'345, -43));
  EXPECT_EQ(e.cuc, test::scaled(-222, -31));
  EXPECT_EQ(e.mean_anomaly, test::angle(-1'717'986'918, -31));
  EXPECT_EQ(e.eccentricity, test::scaled(1'048'576, -33));
  EXPECT_EQ(e.cus, test::scaled(3333, -31));
  EXPECT_EQ(e.crc, test::scaled(7001, -6));
  EXPECT_EQ(e.crs, test::scaled(-1100, -6));
  EXPECT_NEAR(e.sqrt_a, 5282.6, 1e-6);
  EXPECT_EQ(e.inclination, test::angle(657'000'000, -31));
  EXPECT_EQ(e.cic, test::scaled(-44, -31));
  EXPECT_EQ(e.node_rate, test::angle(-21'000, -43));
  EXPECT_EQ(e.cis, test::scaled(55, -31));
  EXPECT_EQ(e.inclination_rate, test::angle(-777, -43));
  EXPECT_EQ(e.node, test::angle(-1'000'000'001, -31));
  EXPECT_EQ(e.perigee, test::angle(999'999'999, -31));
}

TEST(Beidou, D1AndD2HaveTheirNumbersInBothFormsOfChecks) {
  for (const auto form : {test::BeidouForm::kHalves, test::BeidouForm::kInTurn}) {
    const auto navigation =
        navigation_of(timed(beidou(20, 0, d1({}), form) + beidou(3, 1, d2({}), form) + beidou(20, 4, d1({}), form)));
    ASSERT_EQ(navigation.kepler.size(), 2U);
    EXPECT_EQ(record::to_string(navigation.kepler[0].satellite), "C03");
    EXPECT_EQ(record::to_string(navigation.kepler[1].satellite), "C20");
    for (const auto& e : navigation.kepler) expect_beidou(e);
    EXPECT_TRUE(navigation.events.empty());
  }
}

TEST(Beidou, OfDifferentFramesIsNotMixed) {
  auto torn = d1({}), next = d1({.second = 36'012});
  torn[2] = next[2];
  auto pages = d2({});
  pages[6] = d2({.second = 36'012})[6];
  const auto navigation = navigation_of(timed(beidou(20, 0, torn) + beidou(3, 1, pages) + beidou(21, 0, next)));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(record::to_string(navigation.kepler[0].satellite), "C21");
}

TEST(Beidou, WithAWrongBitWeekOrOrbitIsLeftOutAndCounted) {
  std::string spoiled;
  const auto words = test::beidou_words(d1({})[1]);
  for (std::size_t word = 0; word < 10; ++word)
    for (int bit = 0; bit < 30; ++bit) {
      auto wrong = words;
      wrong[word] ^= 1U << bit;
      // Nothing guards the four reserved bits behind the preamble.
      if (word > 0 || bit < 15 || bit >= 19) spoiled += sfrbx(3, 20, 0, 0, wrong);
    }
  const auto navigation = navigation_of(timed(beidou(21, 0, d1({})) + spoiled + beidou(22, 0, d1({.week = 880})) +
                                              beidou(23, 0, d1({.root = std::int64_t{1000} << 19}))));
  EXPECT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 296 + 1);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_impossible"), 1);
}

/// Pages 1 to 4.
std::string fnav(unsigned sv, int issue = 77, int issue3 = 77, int week = kMessageWeek - 1024) {
  const auto page = [&](int type, int iod) { return BitString().put(type, 6).put(iod, 10); };
  BitString one, two = page(2, issue), three = page(3, issue3), four = page(4, issue);
  one.put(1, 6).put(static_cast<int>(sv), 6).put(issue, 10).put(601, 14).put(-700'000, 31).put(800, 21).put(-9, 6).put(107, 8);
  one.put(0, 11 + 11 + 14 + 5).put(-33, 10).put(2, 2).put(week, 12).put(36'000, 20).put(1, 1).put(0, 26);
  two.put(-222'222'222, 32).put(-15'000, 24).put(1'000'000, 32).put(std::llround(5440.6 * (1 << 19)), 32);
  two.put(-1'500'000'000, 32).put(-99, 14).put(week, 12).put(36'010, 20);
  three.put(670'000'000, 32).put(333, 32).put(8000, 16).put(-1, 16).put(2, 16).put(-3, 16).put(4, 16).put(600, 14);
  three.put(week, 12).put(36'020, 20).put(0, 8);
  four.put(-5, 16).put(6, 16).put(0, 166);
  std::string messages;
  for (const BitString& p : {one, two, three, four}) messages += sfrbx(2, sv, 3, 0, test::fnav_page(p));
  return messages;
}

TEST(Fnav, HasItsNumbers) {
  const auto navigation = navigation_of(timed(fnav(7) + fnav(7)));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  const auto& e = navigation.kepler[0];
  EXPECT_EQ(record::to_string(e.satellite), "E07");
  EXPECT_EQ(e.toe, geo::GpsTime::from_week(kMessageWeek, 36'000.0));
  EXPECT_EQ(e.toc, geo::GpsTime::from_week(kMessageWeek, 36'060.0));
  EXPECT_EQ(e.issue, 77);
  EXPECT_EQ(e.sources, 258);
  EXPECT_EQ(e.health, 1 << 3 | 2 << 4);
  EXPECT_NEAR(e.accuracy_m, 3.12, 1e-12);
  EXPECT_EQ(e.clock, (std::array{test::scaled(-700'000, -34), test::scaled(800, -46), test::scaled(-9, -59)}));
  EXPECT_EQ(e.group_delay, (std::array{test::scaled(-33, -32), 0.0}));
  EXPECT_EQ(e.mean_anomaly, test::angle(-222'222'222, -31));
  EXPECT_EQ(e.node_rate, test::angle(-15'000, -43));
  EXPECT_EQ(e.eccentricity, test::scaled(1'000'000, -33));
  EXPECT_NEAR(e.sqrt_a, 5440.6, 1e-6);
  EXPECT_EQ(e.node, test::angle(-1'500'000'000, -31));
  EXPECT_EQ(e.inclination_rate, test::angle(-99, -43));
  EXPECT_EQ(e.inclination, test::angle(670'000'000, -31));
  EXPECT_EQ(e.perigee, test::angle(333, -31));
  EXPECT_EQ(e.delta_n, test::angle(8000, -43));
  EXPECT_EQ(e.cuc, test::scaled(-1, -29));
  EXPECT_EQ(e.cus, test::scaled(2, -29));
  EXPECT_EQ(e.crc, test::scaled(-3, -5));
  EXPECT_EQ(e.crs, test::scaled(4, -5));
  EXPECT_EQ(e.cic, test::scaled(-5, -29));
  EXPECT_EQ(e.cis, test::scaled(6, -29));
}

TEST(Fnav, OfDifferentIssuesAnotherWeekOrWithAWrongBitIsLeftOut) {
  const BitString data = BitString().put(4, 6).put(77, 10).put(0, 198);
  std::string spoiled;
  for (int bit = 0; bit < 238; ++bit) {
    auto words = test::fnav_page(data);
    words[static_cast<std::size_t>(bit / 32)] ^= 1U << (31 - bit % 32);
    spoiled += sfrbx(2, 9, 3, 0, words);
  }
  const auto navigation = navigation_of(timed(fnav(7, 77, 78) + fnav(8) + spoiled + fnav(10, 77, 77, 5)));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(navigation.kepler[0].satellite.number, 8);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 238 + 3);
}

TEST(UbxNavigation, NamesWhatItDoesNotDecode) {
  std::string messages = lnav(0, 7, {}) + sfrbx(0, 7, 4, 0, std::vector<std::uint32_t>(10)) +
                         sfrbx(2, 7, 8, 0, std::vector<std::uint32_t>(8)) + sfrbx(3, 7, 5, 0, std::vector<std::uint32_t>(10)) +
                         sfrbx(1, 123, 0, 0, std::vector<std::uint32_t>(8)) +
                         sfrbx(6, 255, 0, 4, std::vector<std::uint32_t>(4)) + test::ubx(0x02, 0x13, "abc");
  const auto navigation = navigation_of(timed(messages));
  EXPECT_EQ(test::count_of(navigation.events, "navigation_unknown"), 5);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 1);
  std::string texts;
  for (const auto& event : navigation.events) texts += event.text + "\n";
  for (const char* name : {"GPS CNAV", "Galileo C/NAV", "BeiDou CNAV", "SBAS", "unknown satellites"})
    EXPECT_NE(texts.find(name), std::string::npos) << name << "\n" << texts;
}

TEST(UbxNavigation, WithoutATimeIsRefused) {
  const Files files;
  files.put("nav.ubx", lnav(0, 7, {}));
  EXPECT_NE(test::refusal([&] { (void)read_navigation(files.path("nav.ubx")); }).find("states the week"), std::string::npos);
  // NAV-TIMEGPS states it, wherever it comes.
  test::Bytes time;
  time.u4(36'000'000).i4(0).u2(kMessageWeek).i1(18).u1(7).u4(10);
  files.put("timed.ubx", lnav(0, 7, {}) + test::ubx(0x01, 0x20, time.str()));
  EXPECT_EQ(read_navigation(files.path("timed.ubx")).kepler.size(), 1U);
}

}  // namespace
}  // namespace coast::io
