#include "week_time.hpp"

namespace coast::io {

geo::GpsTime week_time(const TableReader& table, std::size_t week_slot, std::size_t seconds_slot) {
  const double week = table.number(week_slot);
  const double seconds = table.number(seconds_slot);
  const bool possible = week >= 0.0 && week <= 1e4 && seconds >= 0.0 && seconds < 604800.0;  // false for NaN
  if (!possible) throw table.error("not a time", "GPS week and seconds of week");
  return geo::GpsTime::from_week(static_cast<int>(week), seconds);
}

}  // namespace coast::io
