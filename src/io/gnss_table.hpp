#pragma once

#include <optional>

#include "coast/io/gnss.hpp"

namespace coast::io {

/// Reads a text table with the columns named in the options (position given).
[[nodiscard]] record::GnssRecording read_gnss_table(TableReader& table, const GnssFileOptions& options,
                                                    std::optional<geo::GpsTime> near);

}  // namespace coast::io
