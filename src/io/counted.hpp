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

/// The same for a reader that has counted several kinds.
class CountedEvents {
 public:
  CountedEvents(record::Events& events, const std::string& file) : events_(events), file_(file) {}

  void operator()(const Counted& counted, const char* kind, const char* one, const char* many, const char* what,
                  record::Event::Severity severity = record::Event::Severity::kWarning) const {
    add_counted(events_, file_, counted, {kind, one, many, what, severity});
  }

 private:
  record::Events& events_;
  const std::string& file_;
};

}  // namespace coast::io
