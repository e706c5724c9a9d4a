#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"

namespace coast::record {

/// Not an error, but must be reported: a gap bridged, an update rejected by the gate, a repeated sample dropped. Every event is
/// listed in `summary.json` and in the report; no repair goes unreported.
struct Event {
  enum class Severity { kInfo, kWarning };
  Severity severity = Severity::kInfo;
  std::string kind;                  ///< short identifier, snake_case: "imu_gap", "gnss_rejected"
  std::string text;                  ///< one plain sentence with numbers
  std::optional<geo::GpsTime> time;  ///< time of the first occurrence
  long count = 1;
};
using Events = std::vector<Event>;

}  // namespace coast::record
