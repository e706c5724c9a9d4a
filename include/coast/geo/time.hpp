#pragma once
// GPS time has its own type. A plain double in seconds is always an interval.

#include <compare>
#include <cstdint>
#include <string>

namespace coast::geo {

/// Calendar date and time of day; the function that uses it states the time scale.
struct Calendar {
  int year = 1980;
  int month = 1;  ///< 1 to 12
  int day = 6;    ///< 1 to 31
  int hour = 0;
  int minute = 0;
  double second = 0.0;  ///< [0, 61)
};

/// An instant in GPS time: integer nanoseconds since 1980-01-06 00:00:00, so differences are exact and the order total.
/// Range about +-292 years. Default-constructed: the GPS epoch.
class GpsTime {
 public:
  constexpr GpsTime() = default;
  /// @param week continuous GPS week (no 1024 rollover)  @param sow seconds of week, any finite value, rounded to 1 ns
  /// @throws std::invalid_argument sow is not finite or the instant is out of range
  [[nodiscard]] static GpsTime from_week(int week, double sow);
  [[nodiscard]] static constexpr GpsTime from_nanoseconds(std::int64_t ns) { return GpsTime(ns); }
  /// @param gpst calendar in the GPS time scale  @throws std::invalid_argument a field is out of its range
  [[nodiscard]] static GpsTime from_calendar(const Calendar& gpst);
  /// @param utc calendar in UTC; a leap second (second >= 60) is accepted where one was inserted
  [[nodiscard]] static GpsTime from_utc(const Calendar& utc);
  /// @param seconds POSIX seconds (UTC without leap seconds) since 1970-01-01
  [[nodiscard]] static GpsTime from_unix_utc(double seconds);

  [[nodiscard]] constexpr std::int64_t nanoseconds() const { return ns_; }
  [[nodiscard]] int week() const;
  [[nodiscard]] double sow() const;  ///< [0, 604800)
  [[nodiscard]] Calendar calendar() const;
  [[nodiscard]] Calendar utc() const;

  constexpr auto operator<=>(const GpsTime&) const = default;
  /// Interval in seconds; exact to 1 ns for intervals below 104 days.
  friend constexpr double operator-(GpsTime a, GpsTime b) { return static_cast<double>(a.ns_ - b.ns_) / 1e9; }
  friend GpsTime operator+(GpsTime t, double seconds);
  friend GpsTime operator-(GpsTime t, double seconds) { return t + (-seconds); }

 private:
  explicit constexpr GpsTime(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

/// GPS minus UTC in whole seconds at an instant of GPS time (table of IERS Bulletin C; 18 s since 2017).
[[nodiscard]] int leap_seconds(GpsTime t);
/// The instant up to which the table is valid; callers warn after it.
[[nodiscard]] GpsTime leap_seconds_expiry();
/// "2025-07-08 19:34:18.499 GPST"
[[nodiscard]] std::string to_string(GpsTime t);

}  // namespace coast::geo
