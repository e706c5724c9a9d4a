#pragma once
// Where a sensor gives no value, or repeats the same one. Private to the room.

#include "coast/array/defects.hpp"

namespace coast::array {

struct Outages {
  std::vector<std::vector<std::uint8_t>> present;  ///< [sensor][column] bit c: a value that may be tested
  std::vector<Defect> defects;                     ///< kDropout and kStuck, one channel each
};

/// Runs of one value are geometric with the probability p that a value repeats; p is the channel's own (its quantisation),
/// estimated locally and over the record. If p is above 0.2 the others must move meanwhile: a coarse sensor at rest may repeat.
/// @param per_hour  false alarms per channel and sensor
[[nodiscard]] Outages find_outages(const Signals& signals, double per_hour);

}  // namespace coast::array
