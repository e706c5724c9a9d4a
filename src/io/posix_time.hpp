#pragma once
// POSIX time in whole nanoseconds, which a double of seconds has no digits for. Private to the room.

#include <cstdint>
#include <optional>

#include "coast/geo/time.hpp"

namespace coast::io {

/// UTC since 1970 without leap seconds; none outside the years 2000 to 2100, where a clock has not been set.
[[nodiscard]] std::optional<geo::GpsTime> gps_from_posix(std::int64_t seconds, std::int64_t nanoseconds);
[[nodiscard]] std::int64_t posix_nanoseconds(geo::GpsTime t);

}  // namespace coast::io
