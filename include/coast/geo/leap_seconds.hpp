#pragma once
// The leap-second table used by GpsTime. It does not change while the process runs.

#include <istream>
#include <optional>
#include <vector>

#include "coast/geo/time.hpp"

namespace coast::geo {

/// From `utc_midnight` on (UTC reads 00:00:00 there) GPS is ahead of UTC by `gps_minus_utc` whole seconds.
struct LeapSecond {
  GpsTime utc_midnight;  ///< the UTC date and time read as if they were GPS time
  int gps_minus_utc;     ///< s
};

struct LeapSecondTable {
  std::vector<LeapSecond> entries;  ///< increasing; before the first entry GPS minus UTC is 0
  GpsTime expiry;                   ///< the table is not valid after this instant
};

/// Table of IERS Bulletin C as built in: the insertions from 1981-07-01 to 2017-01-01, valid up to 2026-06-28 (Bulletin C 70).
[[nodiscard]] const LeapSecondTable& built_in_leap_seconds();

/// Reads the `leap-seconds.list` that IERS and the tz database distribute (NTP seconds, TAI minus UTC, "#@" expiry).
/// Entries before the GPS epoch are left out. Returns nothing if the text is not such a file.
[[nodiscard]] std::optional<LeapSecondTable> parse_leap_seconds_list(std::istream& in);

/// The table in use: the system's tz data if present, consistent with the built-in entries and valid for longer; otherwise the
/// built-in one. Read once.
[[nodiscard]] const LeapSecondTable& leap_second_table();

}  // namespace coast::geo
