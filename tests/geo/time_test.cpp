#include "coast/geo/time.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace coast::geo {
namespace {

void expect_calendar(const Calendar& c, int year, int month, int day, int hour, int minute, double second) {
  EXPECT_EQ(c.year, year);
  EXPECT_EQ(c.month, month);
  EXPECT_EQ(c.day, day);
  EXPECT_EQ(c.hour, hour);
  EXPECT_EQ(c.minute, minute);
  EXPECT_NEAR(c.second, second, 1e-9);
}

TEST(GpsTime, EpochAndWeeks) {
  EXPECT_EQ(GpsTime().nanoseconds(), 0);
  EXPECT_EQ(GpsTime::from_calendar({1980, 1, 6, 0, 0, 0.0}), GpsTime());
  // The two rollovers of the ten-bit week: 1999-08-22 and 2019-04-07 (ICD-GPS-200).
  EXPECT_EQ(GpsTime::from_calendar({1999, 8, 22, 0, 0, 0.0}), GpsTime::from_week(1024, 0.0));
  EXPECT_EQ(GpsTime::from_calendar({2019, 4, 7, 0, 0, 0.0}), GpsTime::from_week(2048, 0.0));
}

TEST(GpsTime, WeekRollsOverWithTheSeconds) {
  EXPECT_EQ(GpsTime::from_week(1023, 604800.0), GpsTime::from_week(1024, 0.0));
  EXPECT_EQ(GpsTime::from_week(1024, -0.25), GpsTime::from_week(1023, 604799.75));
  const GpsTime t = GpsTime::from_week(2190, 604799.999999999);
  EXPECT_EQ(t.week(), 2190);
  EXPECT_EQ(t.sow(), 604799.999999999);
  EXPECT_EQ((t + 1e-9).week(), 2191);
  EXPECT_EQ((t + 1e-9).sow(), 0.0);
  EXPECT_EQ(GpsTime::from_nanoseconds(-1).week(), -1);
}

TEST(GpsTime, SecondsOfWeekAreExactToTheNanosecond) {
  for (const double sow : {0.0, 0.01, 457113.005, 243261.854, 604799.99}) EXPECT_EQ(GpsTime::from_week(2374, sow).sow(), sow);
  EXPECT_EQ(GpsTime::from_week(0, 457113.005).nanoseconds(), 457113005000000);
}

TEST(GpsTime, IntervalsAreExact) {
  const GpsTime t = GpsTime::from_week(2374, 100.0);
  EXPECT_EQ((t + 0.01) - t, 0.01);
  EXPECT_EQ(t - (t + 0.005), -0.005);
  EXPECT_EQ((t - 12345.678901234) + 12345.678901234, t);
  EXPECT_LT(t, t + 1e-9);
  // 10 h at 200 Hz add up without drift.
  GpsTime sum = t;
  for (int i = 0; i < 7200; ++i) sum = sum + 5.0;
  EXPECT_EQ(sum - t, 36000.0);
}

TEST(GpsTime, RefusesWhatIsNoTime) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)GpsTime::from_week(2000, nan), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_week(2000, std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_week(20000, 0.0), std::invalid_argument);
  EXPECT_THROW((void)(GpsTime() + 1e10), std::invalid_argument);
  EXPECT_THROW((void)((GpsTime() + 9e9) + 9e9), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_calendar({2023, 2, 29, 0, 0, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_calendar({2023, 13, 1, 0, 0, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_calendar({2023, 1, 0, 0, 0, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_calendar({2023, 1, 1, 24, 0, 0.0}), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_calendar({2023, 1, 1, 0, 0, 60.0}), std::invalid_argument);
}

TEST(GpsTime, CalendarAgainstCountingDays) {
  const auto leap = [](int y) { return (y % 4 == 0 && y % 100 != 0) || y % 400 == 0; };
  const int lengths[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  int year = 1980, month = 1, day = 6;
  for (int count = 0; count < 60000; ++count) {  // to the year 2144, past the century 2100
    const GpsTime t = GpsTime::from_calendar({year, month, day, 12, 34, 56.5});
    ASSERT_EQ(t.nanoseconds(), (count * 86400LL + 45296) * 1'000'000'000 + 500'000'000);
    const Calendar c = t.calendar();
    ASSERT_TRUE(c.year == year && c.month == month && c.day == day && c.hour == 12 && c.minute == 34 && c.second == 56.5);
    if (++day > lengths[month - 1] + (month == 2 && leap(year) ? 1 : 0)) {
      day = 1;
      if (++month > 12) {
        month = 1;
        ++year;
      }
    }
  }
}

TEST(GpsTime, PublishedInstants) {
  // GPS second 1000000000 is 2011-09-14 01:46:25 UTC; 1167264018 is 2017-01-01 00:00:00 UTC (LIGO's tconvert).
  EXPECT_EQ(GpsTime::from_utc({2011, 9, 14, 1, 46, 25.0}).nanoseconds(), 1'000'000'000LL * 1'000'000'000);
  EXPECT_EQ(GpsTime::from_utc({2017, 1, 1, 0, 0, 0.0}).nanoseconds(), 1'167'264'018LL * 1'000'000'000);
  // POSIX second 1000000000 is 2001-09-09 01:46:40 UTC, GPS 13 s ahead.
  EXPECT_EQ(GpsTime::from_unix_utc(1e9), GpsTime::from_calendar({2001, 9, 9, 1, 46, 53.0}));
  EXPECT_EQ(GpsTime::from_week(2374, 243258.499), GpsTime::from_calendar({2025, 7, 8, 19, 34, 18.499}));
}

TEST(GpsTime, UtcAroundALeapSecond) {
  const GpsTime midnight = GpsTime::from_utc({2017, 1, 1, 0, 0, 0.0});
  EXPECT_EQ(midnight - GpsTime::from_utc({2016, 12, 31, 23, 59, 59.0}), 2.0);
  EXPECT_EQ(midnight - GpsTime::from_utc({2016, 12, 31, 23, 59, 60.25}), 0.75);
  expect_calendar((midnight - 0.75).utc(), 2016, 12, 31, 23, 59, 60.25);
  expect_calendar((midnight - 1.0).utc(), 2016, 12, 31, 23, 59, 60.0);
  expect_calendar((midnight - 1.5).utc(), 2016, 12, 31, 23, 59, 59.5);
  expect_calendar(midnight.utc(), 2017, 1, 1, 0, 0, 0.0);
  // POSIX time has no name for second 60: its label is the next midnight.
  EXPECT_EQ(GpsTime::from_unix_utc(1483228800.0), midnight);
  EXPECT_EQ(GpsTime::from_unix_utc(1483228799.0), midnight - 2.0);
}

TEST(GpsTime, RefusesASecond60ThatNeverWas) {
  EXPECT_THROW((void)GpsTime::from_utc({2016, 12, 30, 23, 59, 60.0}), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_utc({2016, 12, 31, 22, 59, 60.0}), std::invalid_argument);
  EXPECT_THROW((void)GpsTime::from_utc({2016, 12, 31, 23, 59, 61.0}), std::invalid_argument);
  EXPECT_NO_THROW((void)GpsTime::from_utc({2015, 6, 30, 23, 59, 60.5}));
}

TEST(GpsTime, UtcRoundTripOverTheWholeTable) {
  for (std::int64_t day = 0; day < 18000; day += 13) {
    const GpsTime t = GpsTime::from_nanoseconds(day * 86'400'000'000'000 + 123'456'789);
    EXPECT_EQ(GpsTime::from_utc(t.utc()), t);
  }
}

TEST(LeapSeconds, StepsWhereUtcReadsMidnight) {
  const GpsTime midnight = GpsTime::from_utc({2017, 1, 1, 0, 0, 0.0});
  EXPECT_EQ(leap_seconds(midnight - 1e-9), 17);
  EXPECT_EQ(leap_seconds(midnight), 18);
  EXPECT_EQ(leap_seconds(GpsTime()), 0);
  EXPECT_EQ(leap_seconds(GpsTime::from_calendar({2012, 3, 1, 0, 0, 0.0})), 15);
  EXPECT_GE(leap_seconds_expiry(), GpsTime::from_calendar({2026, 6, 28, 0, 0, 0.0}));
}

TEST(GpsTime, Text) {
  EXPECT_EQ(to_string(GpsTime::from_calendar({2025, 7, 8, 19, 34, 18.499})), "2025-07-08 19:34:18.499 GPST");
  EXPECT_EQ(to_string(GpsTime::from_calendar({2025, 12, 31, 23, 59, 59.9996})), "2026-01-01 00:00:00.000 GPST");
}

}  // namespace
}  // namespace coast::geo
