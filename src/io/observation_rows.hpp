#pragma once
// Epochs of observations as a receiver sends them, one after another. Private to the room.

#include <string_view>
#include <vector>

#include "coast/record/observation.hpp"
#include "counted.hpp"

namespace coast::io {

/// Adds epochs to a recording: in the order of time, each signal once, signals sorted. What does not fit is left out and
/// counted.
class ObservationRows {
 public:
  explicit ObservationRows(record::ObservationRecording& recording) : recording_(recording) {}

  /// False, and counted, if the epoch is not after the one before.
  [[nodiscard]] bool begin(geo::GpsTime t);
  /// False, and counted, if the epoch has this signal already.
  [[nodiscard]] bool is_new(record::Satellite satellite, record::Signal signal);
  /// An observation without code and phase is not kept.
  void add(const record::Observation& observation);
  /// An epoch without an observation is left out and counted.
  void end();

  /// @param prefix of the kinds of event
  void report(std::string_view prefix);

 private:
  record::ObservationRecording& recording_;
  geo::GpsTime t_;
  std::vector<record::Observation> row_;
  Counted empty_, doubled_, repeated_, reversed_;
};

}  // namespace coast::io
