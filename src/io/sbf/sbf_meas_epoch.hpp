#pragma once
// MeasEpoch of SBF: all measurements of one epoch. Private to the room.

#include <optional>
#include <string_view>
#include <vector>

#include "coast/record/observation.hpp"

namespace coast::io {

struct SbfMeasurement {
  record::Observation observation;  ///< without lost_lock
  int antenna = 0;                  ///< 0: main
  std::optional<int> channel;       ///< of GLONASS FDMA
  std::optional<int> lock_s;        ///< time that the phase has been locked, cut to seconds; none: no phase
  int longest_lock_s = 0;           ///< longer times are stated as this one
};

struct SbfMeasEpoch {
  std::vector<SbfMeasurement> measurements;
  bool scrambled = false;  ///< the receiver has no permission to output measurements
  int clock_jumps_ms = 0;  ///< of the receiver's clock since it was started, modulo 256
  long unknown = 0;        ///< measurements of undefined satellites and signals, left out
};

/// None for a block that is shorter than its numbers of sub-blocks say.
[[nodiscard]] std::optional<SbfMeasEpoch> sbf_meas_epoch(std::string_view payload);

}  // namespace coast::io
