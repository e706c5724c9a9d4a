// Ephemerides out of SBF: decoded blocks and raw pages of the same numbers give the same.

#include <gtest/gtest.h>

#include <cmath>

#include "coast/geo/units.hpp"
#include "coast/io/rinex.hpp"
#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "io/navigation_messages.hpp"
#include "io/sbf_messages.hpp"

namespace coast::io {
namespace {

using test::BitString;
using test::Bytes;
using test::Files;
using test::sbf;

constexpr unsigned kSbfNavWeek = 2244;
constexpr std::uint32_t kSbfNavTow = 36'000'000;
const geo::GpsTime kSbfNavTime = geo::GpsTime::from_week(kSbfNavWeek, 36000.0);

record::NavigationRecording sbf_navigation_of(const std::string& content) {
  const Files files;
  return read_navigation(std::vector{files.put("nav.sbf", content)});
}

std::string nav_block(unsigned number, const Bytes& b, std::uint32_t tow = kSbfNavTow, unsigned week = kSbfNavWeek) {
  return sbf(number, b.str(), tow, week);
}

double scaled(double value, int exponent) {
  return std::ldexp(value, exponent);
}
float scaled_f(double value, int exponent) {
  return static_cast<float>(std::ldexp(value, exponent));
}

constexpr std::int64_t kRootA = 2'701'996'851;  // 2^-19 sqrt(m): 5153.65

/// From t_oc to IDOT, the numbers of the bits in `lnav`.
Bytes& put_orbit(Bytes& b, std::uint32_t toc, std::uint32_t toe) {
  b.u4(toc).r4(scaled_f(-1, -55)).r4(scaled_f(-1234, -43)).r4(scaled_f(-345'678, -31)).r4(scaled_f(-1100, -5));
  b.r4(scaled_f(12'345, -43)).r8(scaled(-1'717'986'918, -31)).r4(scaled_f(-222, -29)).r8(scaled(104'857'600, -33));
  b.r4(scaled_f(3333, -29)).r8(scaled(static_cast<double>(kRootA), -19)).u4(toe).r4(scaled_f(-44, -29));
  b.r8(scaled(-1'000'000'001, -31)).r4(scaled_f(55, -29)).r8(scaled(657'000'000, -31)).r4(scaled_f(7001, -5));
  return b.r8(scaled(999'999'999, -31)).r4(scaled_f(-21'000, -43)).r4(scaled_f(-777, -43));
}

std::string gps_nav(unsigned number, unsigned prn, unsigned issue3 = 0xa5, unsigned clock = 0x2a5) {
  Bytes b;
  b.u1(prn).u1(0).u2(kSbfNavWeek % 1024).u1(1).u1(2).u1(0).u1(0).u2(clock).u1(0xa5).u1(issue3).u1(0).u1(0);
  put_orbit(b.r4(scaled_f(-11, -31)), 36000, 36000).u2(kSbfNavWeek % 1024).u2(kSbfNavWeek % 1024);
  return nav_block(number, b);
}

/// SVID, check passed, errors, source, frequency number, channel.
Bytes raw_head(unsigned svid, unsigned passed = 1, unsigned freq_nr = 0) {
  Bytes b;
  b.u1(svid).u1(passed).u1(0).u1(0).u1(freq_nr).u1(3);
  return b;
}

std::string lnav_raw(unsigned block, unsigned svid, unsigned passed = 1) {
  BitString one, two, three;
  one.put(kSbfNavWeek % 1024, 10).put(1, 2).put(2, 4).put(0, 6).put(0x2a5 >> 8, 2);
  one.put(0, 24 + 24 + 24 + 16).put(-11, 8).put(0xa5, 8).put(36000 / 16, 16);
  one.put(-1, 8).put(-1234, 16).put(-345'678, 22).put(0, 2);
  two.put(0xa5, 8).put(-1100, 16).put(12'345, 16).put(-1'717'986'918, 32).put(-222, 16).put(104'857'600, 32);
  two.put(3333, 16).put(kRootA, 32).put(36000 / 16, 16).put(0, 6).put(0, 2);
  three.put(-44, 16).put(-1'000'000'001, 32).put(55, 16).put(657'000'000, 32).put(7001, 16).put(999'999'999, 32);
  three.put(-21'000, 24).put(0xa5, 8).put(-777, 14).put(0, 2);
  std::string all;
  int number = 0;
  for (const BitString& data : {one, two, three}) {
    Bytes b = raw_head(svid, passed);
    // Septentrio inverts parities with the data; bits 30 and 31 of a word are reserved.
    for (const std::uint32_t word : test::lnav_subframe(++number, data, test::LnavForm::kWordInverted))
      b.u4(word | 0x80000000U);
    all += nav_block(block, b);
  }
  return all;
}

void expect_gps(const record::KeplerEphemeris& e, double behind = 0.0) {
  EXPECT_NEAR(e.toe - kSbfNavTime, behind, 1e-9);
  EXPECT_NEAR(e.toc - kSbfNavTime, behind, 1e-9);
  EXPECT_EQ(e.group_delay[0], scaled(-11, -31));
  EXPECT_EQ(e.clock, (std::array{scaled(-345'678, -31), scaled(-1234, -43), scaled(-1, -55)}));
  EXPECT_EQ(e.crs, scaled(-1100, -5));
  EXPECT_EQ(e.delta_n, geo::kPi * scaled(12'345, -43));
  EXPECT_EQ(e.mean_anomaly, geo::kPi * scaled(-1'717'986'918, -31));
  EXPECT_EQ(e.cuc, scaled(-222, -29));
  EXPECT_EQ(e.eccentricity, scaled(104'857'600, -33));
  EXPECT_EQ(e.cus, scaled(3333, -29));
  EXPECT_NEAR(e.sqrt_a, 5153.65, 1e-5);
  EXPECT_EQ(e.cic, scaled(-44, -29));
  EXPECT_EQ(e.node, geo::kPi * scaled(-1'000'000'001, -31));
  EXPECT_EQ(e.cis, scaled(55, -29));
  EXPECT_EQ(e.inclination, geo::kPi * scaled(657'000'000, -31));
  EXPECT_EQ(e.crc, scaled(7001, -5));
  EXPECT_EQ(e.perigee, geo::kPi * scaled(999'999'999, -31));
  EXPECT_EQ(e.node_rate, geo::kPi * scaled(-21'000, -43));
  EXPECT_EQ(e.inclination_rate, geo::kPi * scaled(-777, -43));
}

TEST(SbfNavigation, OfGpsAndQzssIsTheSameDecodedAndRaw) {
  for (const std::string& content : {gps_nav(5891, 7) + gps_nav(4095, 182), lnav_raw(4017, 7) + lnav_raw(4066, 182),
                                     lnav_raw(4017, 7) + gps_nav(5891, 7) + gps_nav(4095, 182) + gps_nav(5891, 7)}) {
    const auto navigation = sbf_navigation_of(content);
    ASSERT_EQ(navigation.kepler.size(), 2U);
    EXPECT_EQ(record::to_string(navigation.kepler[0].satellite), "G07");
    EXPECT_EQ(record::to_string(navigation.kepler[1].satellite), "J02");
    for (const auto& e : navigation.kepler) {
      expect_gps(e);
      EXPECT_EQ(e.issue, 0xa5);
      EXPECT_EQ(e.accuracy_m, 4.0);
      EXPECT_EQ(e.sources, 1);
      EXPECT_EQ(e.health, 0);
      EXPECT_EQ(e.group_delay[1], 0.0);
    }
    EXPECT_TRUE(navigation.events.empty());
  }
}

TEST(SbfNavigation, OfBeidouIsInItsOwnTime) {
  Bytes b;
  b.u1(140 + 28).u1(0).u2(888).u1(0).u1(1).u1(3).u1(9).u2(0).r4(scaled_f(-11, -31)).r4(-2e10F);
  put_orbit(b, 36000, 36000).u2(888).u2(888);
  const auto navigation = sbf_navigation_of(nav_block(4081, b));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  const auto& e = navigation.kepler[0];
  expect_gps(e, 14.0);
  EXPECT_EQ(record::to_string(e.satellite), "C28");
  EXPECT_EQ(e.issue, 9);
  EXPECT_EQ(e.health, 1);
  EXPECT_EQ(e.accuracy_m, 2.0);
  EXPECT_EQ(e.group_delay[1], 0.0);
}

std::string gal_nav(unsigned source, unsigned health, float e5a, float e5b) {
  Bytes b;
  b.u1(70 + 21).u1(source).r8(scaled(2'852'651'008, -19)).r8(scaled(-123'456'789, -31)).r8(scaled(1'000'001, -33));
  b.r8(scaled(655'000'001, -31)).r8(scaled(-400'000'001, -31)).r8(scaled(300'000'001, -31)).r4(scaled_f(-16'001, -43));
  b.r4(scaled_f(333, -43)).r4(scaled_f(8001, -43)).r4(scaled_f(-101, -29)).r4(scaled_f(102, -29)).r4(scaled_f(-6003, -5));
  b.r4(scaled_f(1004, -5)).r4(scaled_f(-15, -29)).r4(scaled_f(16, -29)).u4(35'400).u4(35'400);
  b.r4(scaled_f(0, -59)).r4(scaled_f(-4321, -46)).r8(scaled(-7'654'321, -34)).u2(kSbfNavWeek).u2(kSbfNavWeek);
  b.u2(59).u2(health).u1(0).u1(90).u1(107).u1(255).r4(e5a).r4(e5b).r4(-2e10F).u1(255);
  return nav_block(4002, b);
}

/// Words 1 to 5 of I/NAV in raw pages: 114 bits of the even part, 120 of the odd.
std::string inav_raw() {
  BitString one, two, three, four, five;
  one.put(1, 6).put(59, 10).put(590, 14).put(-123'456'789, 32).put(1'000'001, 32).put(2'852'651'008, 32).put(0, 2);
  two.put(2, 6).put(59, 10).put(300'000'001, 32).put(655'000'001, 32).put(-400'000'001, 32).put(333, 14).put(0, 2);
  three.put(3, 6)
      .put(59, 10)
      .put(-16'001, 24)
      .put(8001, 16)
      .put(-101, 16)
      .put(102, 16)
      .put(-6003, 16)
      .put(1004, 16)
      .put(107, 8);
  four.put(4, 6)
      .put(59, 10)
      .put(21, 6)
      .put(-15, 16)
      .put(16, 16)
      .put(590, 14)
      .put(-7'654'321, 31)
      .put(-4321, 21)
      .put(0, 6)
      .put(0, 2);
  five.put(5, 6).put(0, 36 + 5).put(-7, 10).put(9, 10).put(1, 2).put(2, 2).put(1, 1).put(0, 1);
  five.put(kSbfNavWeek - 1024, 12).put(36000, 20).put(0, 23);
  std::string all;
  for (const BitString& word : {one, two, three, four, five}) {
    BitString padded_page, bits;
    for (const std::uint32_t part : test::inav_page(word)) padded_page.put(part, 32);
    bits.put(padded_page.part(0, 114)).put(padded_page.part(128, 120)).put(0x2aa, 22);
    Bytes b = raw_head(70 + 21);
    for (const std::uint32_t part : bits.words()) b.u4(part);
    all += nav_block(4023, b);
  }
  return all;
}

TEST(SbfNavigation, OfGalileoIsTheSameDecodedAndRaw) {
  // E1-B: valid, healthy 2, working; E5b: without guarantee, in test 1.
  const unsigned health = 1U | 0U << 1 | 2U << 2 | 1U << 4 | 1U << 5 | 1U << 6;
  for (const std::string& content : {gal_nav(2, health, scaled_f(-7, -32), scaled_f(9, -32)), inav_raw()}) {
    const auto navigation = sbf_navigation_of(content);
    ASSERT_EQ(navigation.kepler.size(), 1U);
    const auto& e = navigation.kepler[0];
    EXPECT_EQ(record::to_string(e.satellite), "E21");
    EXPECT_EQ(e.toe, geo::GpsTime::from_week(kSbfNavWeek, 35'400.0));
    EXPECT_EQ(e.toc, e.toe);
    EXPECT_EQ(e.clock, (std::array{scaled(-7'654'321, -34), scaled(-4321, -46), 0.0}));
    EXPECT_EQ(e.sqrt_a, scaled(2'852'651'008, -19));
    EXPECT_EQ(e.mean_anomaly, geo::kPi * scaled(-123'456'789, -31));
    EXPECT_EQ(e.eccentricity, scaled(1'000'001, -33));
    EXPECT_EQ(e.inclination, geo::kPi * scaled(655'000'001, -31));
    EXPECT_EQ(e.perigee, geo::kPi * scaled(-400'000'001, -31));
    EXPECT_EQ(e.node, geo::kPi * scaled(300'000'001, -31));
    EXPECT_EQ(e.node_rate, geo::kPi * scaled(-16'001, -43));
    EXPECT_EQ(e.inclination_rate, geo::kPi * scaled(333, -43));
    EXPECT_EQ(e.delta_n, geo::kPi * scaled(8001, -43));
    EXPECT_EQ(e.cuc, scaled(-101, -29));
    EXPECT_EQ(e.cus, scaled(102, -29));
    EXPECT_EQ(e.crc, scaled(-6003, -5));
    EXPECT_EQ(e.crs, scaled(1004, -5));
    EXPECT_EQ(e.cic, scaled(-15, -29));
    EXPECT_EQ(e.cis, scaled(16, -29));
    EXPECT_EQ(e.issue, 59);
    EXPECT_EQ(e.sources, 517);
    EXPECT_NEAR(e.accuracy_m, 3.12, 1e-9);
    EXPECT_EQ(e.group_delay, (std::array{scaled(-7, -32), scaled(9, -32)}));
    EXPECT_EQ(e.health, 2 << 1 | 1 << 6 | 1 << 7);
  }
}

TEST(SbfNavigation, OfFnavHasItsOwnHealthAndAccuracy) {
  const auto navigation = sbf_navigation_of(gal_nav(16, 1U << 8 | 1U << 9 | 3U << 10, scaled_f(-7, -32), -2e10F));
  ASSERT_EQ(navigation.kepler.size(), 1U);
  const auto& e = navigation.kepler[0];
  EXPECT_EQ(e.sources, 258);
  EXPECT_EQ(e.health, 1 << 3 | 3 << 4);
  EXPECT_NEAR(e.accuracy_m, 1.6, 1e-9);
  EXPECT_EQ(e.group_delay, (std::array{scaled(-7, -32), 0.0}));
}

/// t_b 9 h 45 min in Moscow, 6 h 45 min UTC: 18 s more in GPS time.
constexpr std::uint32_t kGloToe = 24'318;

std::string glo_nav(unsigned freq_nr = 6, unsigned health = 0, unsigned malfunction = 0) {
  Bytes b;
  b.u1(37 + 9).u1(freq_nr).r8(scaled(14'000'001, -11)).r8(scaled(-25'000'003, -11)).r8(scaled(43'000'005, -11));
  b.r4(scaled_f(-1'000'001, -20)).r4(scaled_f(2'000'003, -20)).r4(scaled_f(1'500'005, -20));
  b.r4(scaled_f(1, -30)).r4(scaled_f(-2, -30)).r4(scaled_f(3, -30)).r4(scaled_f(-777, -40)).r4(scaled_f(123'456, -30)).r4(0);
  b.u4(kGloToe).u2(kSbfNavWeek % 1024).u1(30).u1(1).u1(0).u1(health).u2(585).u1(1).u1(0).u1(malfunction).u1(0).u2(700).u2(250);
  return nav_block(4004, b.u1(1), 24'500'000);
}

std::string glo_raw() {
  BitString one, two, three, four;
  one.put(0, 1).put(1, 4).put(0, 2 + 2 + 12).put_signed(-1'000'001, 24).put_signed(1, 5).put_signed(14'000'001, 27);
  two.put(0, 1)
      .put(2, 4)
      .put(0, 3)
      .put(1, 1)
      .put(39, 7)
      .put(0, 5)
      .put_signed(2'000'003, 24)
      .put_signed(-2, 5)
      .put_signed(-25'000'003, 27);
  three.put(0, 1)
      .put(3, 4)
      .put(1, 1)
      .put_signed(-777, 11)
      .put(0, 1 + 2 + 1)
      .put_signed(1'500'005, 24)
      .put_signed(3, 5)
      .put_signed(43'000'005, 27);
  four.put(0, 1).put(4, 4).put_signed(123'456, 22).put(0, 5 + 5 + 14 + 1 + 4 + 3 + 11).put(9, 5).put(0, 2);
  std::string all;
  std::uint32_t ends = 24'500'000;
  for (const BitString& string : {one, two, three, four}) {
    Bytes b = raw_head(37 + 9, 1, 6);
    const auto words = test::glonass_string(string, 0);
    for (std::size_t i = 0; i < 3; ++i) b.u4(words[i]);
    all += nav_block(4026, b, ends);
    ends += 2000;
  }
  return all;
}

TEST(SbfNavigation, OfGlonassIsTheSameDecodedAndRaw) {
  for (const std::string& content : {glo_nav(), glo_raw()}) {
    const auto navigation = sbf_navigation_of(content);
    ASSERT_EQ(navigation.tabulated.size(), 1U);
    const auto& e = navigation.tabulated[0];
    EXPECT_EQ(record::to_string(e.satellite), "R09");
    EXPECT_EQ(e.t, geo::GpsTime::from_week(kSbfNavWeek, kGloToe));
    EXPECT_EQ(e.r_e, 1000.0 * Eigen::Vector3d(scaled(14'000'001, -11), scaled(-25'000'003, -11), scaled(43'000'005, -11)));
    EXPECT_EQ(e.v_e, 1000.0 * Eigen::Vector3d(scaled(-1'000'001, -20), scaled(2'000'003, -20), scaled(1'500'005, -20)));
    EXPECT_EQ(e.a_e, 1000.0 * Eigen::Vector3d(scaled(1, -30), scaled(-2, -30), scaled(3, -30)));
    EXPECT_EQ(e.clock_bias, -scaled(123'456, -30));
    EXPECT_EQ(e.clock_drift, scaled(-777, -40));
    EXPECT_EQ(e.channel, -2);
    EXPECT_EQ(e.health, 0);
  }
  EXPECT_EQ(sbf_navigation_of(glo_nav(6, 4)).tabulated.at(0).health, 1);
  EXPECT_EQ(sbf_navigation_of(glo_nav(6, 3)).tabulated.at(0).health, 0);
  EXPECT_EQ(sbf_navigation_of(glo_nav(6, 0, 1)).tabulated.at(0).health, 1);
  EXPECT_EQ(sbf_navigation_of(glo_nav()).tabulated.at(0).accuracy_m, 2.5);
}

TEST(SbfNavigation, HasTheIonosphereOfGps) {
  Bytes b;
  b.u1(7).u1(0).r4(scaled_f(12, -30)).r4(scaled_f(-3, -27)).r4(scaled_f(-1, -24)).r4(scaled_f(2, -24));
  b.r4(scaled_f(44, 11)).r4(scaled_f(-5, 14)).r4(scaled_f(-1, 16)).r4(scaled_f(3, 16));
  const auto ionosphere = sbf_navigation_of(nav_block(5893, b) + gps_nav(5891, 7)).gps_ionosphere;
  ASSERT_TRUE(ionosphere);
  EXPECT_EQ(ionosphere->alpha, (std::array{scaled(12, -30), scaled(-3, -27), scaled(-1, -24), scaled(2, -24)}));
  EXPECT_EQ(ionosphere->beta, (std::array{scaled(44, 11), scaled(-5, 14), scaled(-1, 16), scaled(3, 16)}));
}

TEST(SbfNavigation, ThatCannotBeIsLeftOutAndCounted) {
  std::string nan = gps_nav(5891, 8).substr(8 + 6);
  const float not_a_number = NAN;
  nan.replace(34, 4, reinterpret_cast<const char*>(&not_a_number), 4);  // C_rs
  const std::string before_time = sbf(5891, gps_nav(5891, 7).substr(8 + 6), 0xffffffff, 65535);
  const auto navigation = sbf_navigation_of(
      before_time + gps_nav(5891, 7) + gps_nav(5891, 8, 0xa6) + gps_nav(5891, 9, 0xa5, 0x2a4) + gps_nav(5891, 150) +
      sbf(5891, "ab", kSbfNavTow, kSbfNavWeek) + lnav_raw(4017, 8, 0) + glo_nav(0) + sbf(5891, nan, kSbfNavTow, kSbfNavWeek));
  EXPECT_EQ(navigation.kepler.size(), 1U);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_spoiled"), 8);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_impossible"), 1);
  EXPECT_EQ(test::count_of(navigation.events, "navigation_no_time"), 1);
  EXPECT_NE(test::refusal([] { sbf_navigation_of(sbf(4007, "ab")); }).find("without an ephemeris"), std::string::npos);
}

}  // namespace
}  // namespace coast::io
