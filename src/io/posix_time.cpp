#include "posix_time.hpp"

namespace coast::io {

std::optional<geo::GpsTime> gps_from_posix(std::int64_t seconds, std::int64_t nanoseconds) {
  constexpr std::int64_t kFirst = 946'684'800, kLast = 4'102'444'800;  // s: years 2000 to 2100
  if (seconds < kFirst || seconds > kLast) return std::nullopt;
  const geo::GpsTime whole = geo::GpsTime::from_unix_utc(static_cast<double>(seconds));
  return geo::GpsTime::from_nanoseconds(whole.nanoseconds() + nanoseconds);
}

std::int64_t posix_nanoseconds(geo::GpsTime t) {
  constexpr std::int64_t kGpsEpoch = 315'964'800, kNano = 1'000'000'000;  // s after 1970; ns
  return t.nanoseconds() + kNano * (kGpsEpoch - geo::leap_seconds(t));
}

}  // namespace coast::io
