#pragma once
// Instants of outside events, such as a camera's shutter, as a receiver has timed them.

#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::record {

/// One edge at an input of the receiver.
struct TimeMark {
  geo::GpsTime t;
  double sd_s = 0.0;    ///< as stated
  int channel = 0;      ///< input
  bool rising = false;  ///< edge
  int count = 0;        ///< rising edges at this input so far, modulo 2^16
};

struct TimeMarkRecording {
  std::string source;
  std::vector<TimeMark> marks;  ///< in the order of time
  Events events;
};

}  // namespace coast::record
