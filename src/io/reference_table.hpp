#pragma once

#include <optional>

#include "coast/io/reference.hpp"

namespace coast::io {

/// Reads a text table with the columns named in the options (position given).
[[nodiscard]] record::Trajectory read_reference_table(TableReader& table, const ReferenceFileOptions& options,
                                                      std::optional<geo::GpsTime> near);

}  // namespace coast::io
