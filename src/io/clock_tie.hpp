#pragma once
// Ties a sensor's free-running counter to GPS time by what else its stream says. Private to the room.

#include <cstdint>
#include <optional>
#include <vector>

#include "coast/geo/time.hpp"

namespace coast::io {

/// Straight line from counter readings to GPS time through pairs that are late by varying delays.
class ClockTie {
 public:
  /// @param nominal_tick  s of one count, if it is known: kept where the pairs are less than a minute apart
  explicit ClockTie(std::optional<double> nominal_tick = std::nullopt) : nominal_(nominal_tick) {}

  /// Counter and GPS time that belong together; counters do not decrease.
  void add(std::int64_t counter, geo::GpsTime t) { pairs_.push_back({counter, t}); }

  /// Least squares, without pairs further from a first line than three times the median distance.  @return false: fewer than
  /// ten pairs, or, without a nominal tick, less than ten seconds between them
  [[nodiscard]] bool fit();
  /// None for a counter that is months from those of the pairs.
  [[nodiscard]] std::optional<geo::GpsTime> at(std::int64_t counter) const;
  [[nodiscard]] double tick_s() const { return tick_; }
  [[nodiscard]] double median_distance_s() const { return distance_; }

 private:
  struct Pair {
    std::int64_t counter;
    geo::GpsTime t;
  };
  [[nodiscard]] double seconds_at(std::int64_t counter) const;
  [[nodiscard]] double distance(const Pair& pair) const;
  [[nodiscard]] bool fit_within(double most);

  std::optional<double> nominal_;
  std::vector<Pair> pairs_;
  double tick_ = 0.0;    ///< s
  double offset_ = 0.0;  ///< s, of the first pair's counter from its time
  double distance_ = 0.0;
};

/// A counter of 32 bits without its overflows.
class CounterUnwrap {
 public:
  [[nodiscard]] std::int64_t operator()(std::uint32_t counter) {
    // The difference modulo 2^32, as a signed number: steps back stay steps back.
    if (started_) last_ += static_cast<std::int32_t>(counter - static_cast<std::uint32_t>(last_));
    if (!started_) last_ = counter;
    started_ = true;
    return last_;
  }

 private:
  std::int64_t last_ = 0;
  bool started_ = false;
};

}  // namespace coast::io
