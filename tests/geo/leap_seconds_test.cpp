#include "coast/geo/leap_seconds.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace coast::geo {
namespace {

std::optional<LeapSecondTable> parse(const std::string& text) {
  std::istringstream in(text);
  return parse_leap_seconds_list(in);
}

TEST(LeapSecondTable, BuiltInIsEighteenStepsOfOne) {
  const LeapSecondTable& table = built_in_leap_seconds();
  ASSERT_EQ(table.entries.size(), 18U);
  for (std::size_t i = 0; i < table.entries.size(); ++i) EXPECT_EQ(table.entries[i].gps_minus_utc, static_cast<int>(i) + 1);
}

TEST(LeapSecondTable, AgreesWithTheSystemsList) {
  std::ifstream list("/usr/share/zoneinfo/leap-seconds.list");
  if (!list) GTEST_SKIP() << "no leap-seconds.list on this machine";
  const auto system = parse_leap_seconds_list(list);
  ASSERT_TRUE(system);
  const auto& built_in = built_in_leap_seconds().entries;
  for (std::size_t i = 0; i < std::min(built_in.size(), system->entries.size()); ++i) {
    EXPECT_EQ(system->entries[i].utc_midnight, built_in[i].utc_midnight) << i;
    EXPECT_EQ(system->entries[i].gps_minus_utc, built_in[i].gps_minus_utc) << i;
  }
}

TEST(LeapSecondTable, ReadsTheDistributedForm) {
  // Lines as IERS writes them; 3991593600 is 2026-06-28, 2571782400 is 1981-07-01.
  const auto table =
      parse("# comment\n#@\t3991593600\n2272060800\t10\t# 1 Jan 1972\n2571782400 20 # 1 Jul 1981\n#h 49db2447\n");
  ASSERT_TRUE(table);
  ASSERT_EQ(table->entries.size(), 1U);  // 1972 is before GPS
  EXPECT_EQ(table->entries[0].utc_midnight, GpsTime::from_calendar({1981, 7, 1, 0, 0, 0.0}));
  EXPECT_EQ(table->entries[0].gps_minus_utc, 1);
  EXPECT_EQ(table->expiry, GpsTime::from_calendar({2026, 6, 28, 0, 0, 0.0}));
}

TEST(LeapSecondTable, RefusesOtherTexts) {
  EXPECT_FALSE(parse(""));
  EXPECT_FALSE(parse("#@ 3991593600\n"));  // no entries
  EXPECT_FALSE(parse("2571782400 20\n"));  // no expiry
  EXPECT_FALSE(parse("#@ 3991593600\nhello\n"));
  EXPECT_FALSE(parse("#@ 3991593600\n2571782400\n"));                    // no offset
  EXPECT_FALSE(parse("#@ 3991593600\n2603318400 21\n2571782400 20\n"));  // not in order
  EXPECT_FALSE(parse("#@ 99999999999999999\n2571782400 20\n"));
}

}  // namespace
}  // namespace coast::geo
