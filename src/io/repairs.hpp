#pragma once
// Counts of repairs by a reader; check of time order.

#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/io/table.hpp"
#include "coast/io/time_column.hpp"
#include "coast/record/event.hpp"

namespace coast::io {

/// Counts repairs by kind and turns them into events. Each kind has a fraction of rows above which the file is rejected.
class Repairs {
 public:
  /// @param most_share  more than this fraction of all rows (and more than 10) means a wrong file or format
  void add(const char* kind, const char* what, double most_share, const InputError& as_error, std::optional<geo::GpsTime> time);
  /// Appends one event per kind.  @throws InputError a kind exceeds its fraction (with the place of its first)
  void finish(long rows, record::Events& events) const;

 private:
  struct Entry {
    const char* kind;
    const char* what;
    double most_share;
    InputError first;
    std::optional<geo::GpsTime> time;
    long count;
  };
  std::vector<Entry> entries_;
};

/// Checks that times increase. Steps back by at most one sample, and repeated times, are omitted and counted; larger
/// ones are rejected.
class TimeOrder {
 public:
  TimeOrder(WeekClock::MakeError error, Repairs& repairs) : error_(std::move(error)), repairs_(repairs) {}
  TimeOrder(const TableReader& table, Repairs& repairs)
      : TimeOrder([&table](auto found, auto expected, auto what_to_do) { return table.error(found, expected, what_to_do); },
                  repairs) {}
  /// True if the row is to be kept.  @param same_values the row repeats the one before in every value
  [[nodiscard]] bool accept(geo::GpsTime t, bool same_values);

 private:
  WeekClock::MakeError error_;
  Repairs& repairs_;
  std::optional<geo::GpsTime> last_;
  double step_ = 0.0;  ///< last step forward, s
};

}  // namespace coast::io
