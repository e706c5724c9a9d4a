#pragma once
// What a reader left out or noticed, counted by kind, as events. Private to the room.

#include <optional>
#include <string>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::io {

struct Counted {
  long number = 0;
  std::optional<geo::GpsTime> first = {};

  void add(std::optional<geo::GpsTime> t = std::nullopt) {
    if (number++ == 0) first = t;
  }
};

struct CountedWords {
  const char* kind;  ///< of the event
  const char* one;   ///< "epoch"
  const char* many;  ///< "epochs"
  std::string what;  ///< "without a signal left out"
  record::Event::Severity severity = record::Event::Severity::kWarning;
};

/// "FILE: 3 epochs without a signal left out; first at .."; nothing if none was counted.
void add_counted(record::Events& events, const std::string& file, const Counted& counted, const CountedWords& words);

}  // namespace coast::io
