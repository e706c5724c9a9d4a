#pragma once

#include <tbb/task_group.h>

#include <cstddef>
#include <vector>

#include "coast/record/trajectory.hpp"

namespace coast::jobs {

/// Takes epochs from a filter and passes them to a sink on another thread, in order and in batches, so that the filter
/// continues while text is written. An exception of the sink is rethrown by a later call.
class BackgroundSink {
 public:
  explicit BackgroundSink(record::EpochSink sink);
  /// Waits; exceptions of the sink are lost then: call `finish` first.
  ~BackgroundSink();
  BackgroundSink(const BackgroundSink&) = delete;
  BackgroundSink& operator=(const BackgroundSink&) = delete;

  void add(const record::TrajectoryEpoch& epoch);
  /// Returns after the sink has taken all epochs.
  void finish();

 private:
  void hand_over();

  record::EpochSink sink_;
  std::vector<record::TrajectoryEpoch> filling_;
  std::vector<record::TrajectoryEpoch> emptying_;
  tbb::task_group work_;
};

}  // namespace coast::jobs
