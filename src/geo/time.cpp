#include "coast/geo/time.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "coast/geo/leap_seconds.hpp"

namespace coast::geo {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns
constexpr std::int64_t kMinute = 60 * kSecond;
constexpr std::int64_t kHourNs = 60 * kMinute;
constexpr std::int64_t kDay = 24 * kHourNs;
constexpr std::int64_t kWeek = 7 * kDay;
constexpr double kLimit = 9.2e9;  // s; int64 nanoseconds end at 9.22e9

constexpr std::chrono::sys_days kGpsEpoch = std::chrono::year{1980} / 1 / 6;
constexpr double kGpsEpochUnix = 315964800.0;  // s

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

// Splits before scaling: a product with 1e9 would round above 2^53 ns (104 days).
std::int64_t to_nanoseconds(double seconds) {
  if (!std::isfinite(seconds) || std::abs(seconds) > kLimit) {
    throw std::invalid_argument(fmt::format("interval of {} s, must be finite and below {} s", seconds, kLimit));
  }
  const double whole = std::floor(seconds);
  return static_cast<std::int64_t>(whole) * kSecond + std::llround((seconds - whole) * 1e9);
}

std::int64_t checked_sum(std::int64_t a, std::int64_t b) {
  const double sum = static_cast<double>(a) * 1e-9 + static_cast<double>(b) * 1e-9;
  if (std::abs(sum) > kLimit) {
    throw std::invalid_argument(fmt::format("instant {} s from the GPS epoch is out of range (+-{} s)", sum, kLimit));
  }
  return a + b;
}

void check(const char* field, double value, double low, double high_exclusive) {
  if (!(value >= low && value < high_exclusive)) {
    throw std::invalid_argument(
        fmt::format("{} = {} in a calendar date, must be in [{}, {})", field, value, low, high_exclusive));
  }
}

// Instant of the start of the calendar's minute, in the calendar's own time scale.
std::int64_t minute_start(const Calendar& c) {
  check("year", c.year, 1700, 2270);
  check("month", c.month, 1, 13);
  check("hour", c.hour, 0, 24);
  check("minute", c.minute, 0, 60);
  const std::chrono::year_month_day date = std::chrono::year{c.year} / c.month / c.day;
  if (c.day < 1 || !date.ok()) {
    throw std::invalid_argument(fmt::format("{:04}-{:02} has no day {}", c.year, c.month, c.day));
  }
  const auto days = (std::chrono::sys_days{date} - kGpsEpoch).count();
  return days * kDay + c.hour * kHourNs + c.minute * kMinute;
}

Calendar calendar_of(std::int64_t ns) {
  const std::int64_t days = floor_div(ns, kDay);
  const std::int64_t in_day = ns - days * kDay;
  const std::chrono::year_month_day date{kGpsEpoch + std::chrono::days{days}};
  Calendar c;
  c.year = static_cast<int>(date.year());
  c.month = static_cast<int>(static_cast<unsigned>(date.month()));
  c.day = static_cast<int>(static_cast<unsigned>(date.day()));
  c.hour = static_cast<int>(in_day / kHourNs);
  c.minute = static_cast<int>(in_day / kMinute % 60);
  c.second = static_cast<double>(in_day % kMinute) / 1e9;
  return c;
}

// GPS minus UTC at a UTC label (nanoseconds as if the label were GPS time).
int offset_at_utc(std::int64_t utc_label) {
  int offset = 0;
  for (const LeapSecond& entry : leap_second_table().entries) {
    if (entry.utc_midnight.nanoseconds() > utc_label) break;
    offset = entry.gps_minus_utc;
  }
  return offset;
}

}  // namespace

GpsTime GpsTime::from_week(int week, double sow) {
  constexpr int kMaxWeek = 15200;  // the product below ends at 15250
  if (week < -kMaxWeek || week > kMaxWeek) throw std::invalid_argument(fmt::format("GPS week {} is out of range", week));
  return GpsTime(checked_sum(week * kWeek, to_nanoseconds(sow)));
}

GpsTime GpsTime::from_calendar(const Calendar& gpst) {
  const std::int64_t minute = minute_start(gpst);
  check("second", gpst.second, 0.0, 60.0);
  return GpsTime(minute + to_nanoseconds(gpst.second));
}

GpsTime GpsTime::from_utc(const Calendar& utc) {
  const std::int64_t minute = minute_start(utc);
  check("second", utc.second, 0.0, 61.0);
  // A leap second belongs to the minute before it: the offset is that of the minute's start.
  const int offset = offset_at_utc(minute);
  if (utc.second >= 60.0 && offset_at_utc(minute + kMinute) <= offset) {
    throw std::invalid_argument(fmt::format("no leap second was inserted at the end of {:04}-{:02}-{:02} {:02}:{:02} UTC",
                                            utc.year, utc.month, utc.day, utc.hour, utc.minute));
  }
  return GpsTime(minute + offset * kSecond + to_nanoseconds(utc.second));
}

GpsTime GpsTime::from_unix_utc(double seconds) {
  const std::int64_t label = to_nanoseconds(seconds - kGpsEpochUnix);
  return GpsTime(checked_sum(label, offset_at_utc(label) * kSecond));
}

int GpsTime::week() const {
  return static_cast<int>(floor_div(ns_, kWeek));
}

double GpsTime::sow() const {
  return static_cast<double>(ns_ - floor_div(ns_, kWeek) * kWeek) / 1e9;
}

Calendar GpsTime::calendar() const {
  return calendar_of(ns_);
}

Calendar GpsTime::utc() const {
  const int offset = leap_seconds(*this);
  const std::int64_t label = ns_ - offset * kSecond;
  // With the old offset still valid the label has reached the new day: this is second 60 of the day before.
  if (offset_at_utc(label) > offset) {
    Calendar c = calendar_of(label - kSecond);
    c.second += 1.0;
    return c;
  }
  return calendar_of(label);
}

GpsTime operator+(GpsTime t, double seconds) {
  return GpsTime(checked_sum(t.ns_, to_nanoseconds(seconds)));
}

int leap_seconds(GpsTime t) {
  int offset = 0;
  for (const LeapSecond& entry : leap_second_table().entries) {
    if (entry.utc_midnight.nanoseconds() + entry.gps_minus_utc * kSecond > t.nanoseconds()) break;
    offset = entry.gps_minus_utc;
  }
  return offset;
}

GpsTime leap_seconds_expiry() {
  return leap_second_table().expiry;
}

std::string to_string(GpsTime t) {
  constexpr std::int64_t kMillisecond = 1'000'000;
  // Rounded first, so that 59.9996 s becomes the next minute, not second 60.
  const std::int64_t ms = floor_div(t.nanoseconds() + kMillisecond / 2, kMillisecond);
  const Calendar c = calendar_of(ms * kMillisecond);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:06.3f} GPST", c.year, c.month, c.day, c.hour, c.minute, c.second);
}

}  // namespace coast::geo
