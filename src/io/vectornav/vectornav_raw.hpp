#pragma once
// The field RawMeas of VectorNav messages: what one receiver has measured at one time. Private to the room.

#include <optional>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/observation.hpp"
#include "vectornav_message.hpp"

namespace coast::io {

struct VectorNavRaw {
  std::optional<geo::GpsTime> t;  ///< none before the receiver knows it
  struct Measurement {
    record::Observation observation;  ///< lost_lock: the receiver has seen a slip of the phase
    std::optional<int> channel;       ///< of GLONASS
  };
  std::vector<Measurement> measurements;
  long unknown = 0;     ///< measurements of an unknown satellite or signal
  long impossible = 0;  ///< measurements that no receiver makes
};

/// RawMeas of a GNSS group; none if the message has none, or one without measurements.
[[nodiscard]] std::optional<VectorNavRaw> vectornav_raw(const VectorNavMessage& message, VectorNavGroup group);

}  // namespace coast::io
