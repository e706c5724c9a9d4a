#include "coast/geo/leap_seconds.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

namespace coast::geo {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kGpsEpochNtp = 2'524'953'600;  // 1980-01-06 in seconds since 1900-01-01
constexpr int kTaiMinusGps = 19;                      // s, constant by definition of GPS time

LeapSecondTable make_built_in() {
  struct Row {
    int year, month, gps_minus_utc;
  };
  constexpr Row kRows[] = {{1981, 7, 1},  {1982, 7, 2},  {1983, 7, 3},  {1985, 7, 4},  {1988, 1, 5},  {1990, 1, 6},
                           {1991, 1, 7},  {1992, 7, 8},  {1993, 7, 9},  {1994, 7, 10}, {1996, 1, 11}, {1997, 7, 12},
                           {1999, 1, 13}, {2006, 1, 14}, {2009, 1, 15}, {2012, 7, 16}, {2015, 7, 17}, {2017, 1, 18}};
  LeapSecondTable table;
  for (const Row& row : kRows) {
    table.entries.push_back({GpsTime::from_calendar({row.year, row.month, 1, 0, 0, 0.0}), row.gps_minus_utc});
  }
  table.expiry = GpsTime::from_calendar({2026, 6, 28, 0, 0, 0.0});
  return table;
}

GpsTime from_ntp(std::int64_t seconds) {
  return GpsTime::from_nanoseconds((seconds - kGpsEpochNtp) * kNanosecondsPerSecond);
}

// A list that contradicts past leap seconds is not used for future ones.
bool extends(const LeapSecondTable& longer, const LeapSecondTable& base) {
  return longer.expiry > base.expiry && longer.entries.size() >= base.entries.size() &&
         std::equal(base.entries.begin(), base.entries.end(), longer.entries.begin(), [](const auto& a, const auto& b) {
           return a.utc_midnight == b.utc_midnight && a.gps_minus_utc == b.gps_minus_utc;
         });
}

LeapSecondTable choose_table() {
  std::ifstream list("/usr/share/zoneinfo/leap-seconds.list");
  if (list) {
    auto system = parse_leap_seconds_list(list);
    if (system && extends(*system, built_in_leap_seconds())) return *std::move(system);
  }
  return built_in_leap_seconds();
}

}  // namespace

const LeapSecondTable& built_in_leap_seconds() {
  static const LeapSecondTable table = make_built_in();
  return table;
}

std::optional<LeapSecondTable> parse_leap_seconds_list(std::istream& in) {
  constexpr std::int64_t kPlausibleNtp = 10'000'000'000;  // year 2216: a later one means another kind of text
  LeapSecondTable table;
  bool has_expiry = false;
  for (std::string line; std::getline(in, line);) {
    const bool expiry_line = line.rfind("#@", 0) == 0;
    if (line.empty() || (line.front() == '#' && !expiry_line)) continue;
    std::istringstream fields(expiry_line ? line.substr(2) : line);
    std::int64_t ntp = 0;
    if (!(fields >> ntp) || ntp < 0 || ntp > kPlausibleNtp) return std::nullopt;
    if (expiry_line) {
      table.expiry = from_ntp(ntp);
      has_expiry = true;
      continue;
    }
    int tai_minus_utc = 0;
    if (!(fields >> tai_minus_utc)) return std::nullopt;
    if (ntp <= kGpsEpochNtp) continue;
    if (!table.entries.empty() && from_ntp(ntp) <= table.entries.back().utc_midnight) return std::nullopt;
    table.entries.push_back({from_ntp(ntp), tai_minus_utc - kTaiMinusGps});
  }
  if (!has_expiry || table.entries.empty()) return std::nullopt;
  return table;
}

const LeapSecondTable& leap_second_table() {
  static const LeapSecondTable table = choose_table();
  return table;
}

}  // namespace coast::geo
