#include "counted.hpp"

#include <fmt/format.h>

namespace coast::io {

void add_counted(record::Events& events, const std::string& file, const Counted& counted, const CountedWords& words) {
  if (counted.number == 0) return;
  events.push_back({words.severity, words.kind,
                    fmt::format("{}: {} {} {}{}", file, counted.number, counted.number == 1 ? words.one : words.many,
                                words.what, counted.first ? "; first at " + geo::to_string(*counted.first) : ""),
                    counted.first, counted.number});
}

}  // namespace coast::io
