#pragma once

#include "coast/geo/time.hpp"
#include "coast/io/table.hpp"

namespace coast::io {

/// GPS week and seconds of week of the current row.  @throws InputError  not a valid time
[[nodiscard]] geo::GpsTime week_time(const TableReader& table, std::size_t week_slot, std::size_t seconds_slot);

}  // namespace coast::io
