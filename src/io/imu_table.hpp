#pragma once

#include <optional>

#include "coast/io/imu.hpp"

namespace coast::io {

/// Reads a text table with the columns named in the options (all of them given).
[[nodiscard]] record::ImuRecording read_imu_table(TableReader& table, const ImuFileOptions& options,
                                                  std::optional<geo::GpsTime> near);

}  // namespace coast::io
