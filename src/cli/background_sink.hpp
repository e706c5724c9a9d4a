#pragma once

#include <tbb/task_group.h>

#include <cstddef>
#include <vector>

#include "coast/record/trajectory.hpp"

namespace coast::cli {

/// Takes epochs from a filter and gives them to a sink on another thread, in order and a batch at a time, so that the filter
/// goes on while text is written. What the sink throws comes out of a later call.
class BackgroundSink {
 public:
  explicit BackgroundSink(record::EpochSink sink);
  /// Waits; what the sink throws then is lost, `finish` first.
  ~BackgroundSink();
  BackgroundSink(const BackgroundSink&) = delete;
  BackgroundSink& operator=(const BackgroundSink&) = delete;

  void add(const record::TrajectoryEpoch& epoch);
  /// Returns when the sink has taken all epochs.
  void finish();

 private:
  void hand_over();

  record::EpochSink sink_;
  std::vector<record::TrajectoryEpoch> filling_;
  std::vector<record::TrajectoryEpoch> emptying_;
  tbb::task_group work_;
};

}  // namespace coast::cli
