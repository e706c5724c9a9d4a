#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"

namespace coast::record {

/// Something that is not an error but must be known: a gap bridged, an update gated, a repeated sample dropped.
/// Every event stands in `summary.json` and on the page; nothing is repaired in silence.
struct Event {
  enum class Severity { kInfo, kWarning };
  Severity severity = Severity::kInfo;
  std::string kind;                  ///< short identifier, snake_case: "imu_gap", "gnss_rejected"
  std::string text;                  ///< one plain sentence with numbers
  std::optional<geo::GpsTime> time;  ///< first place
  long count = 1;
};
using Events = std::vector<Event>;

}  // namespace coast::record
