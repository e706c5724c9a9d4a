#pragma once

#include <string>
#include <vector>

#include "coast/jobs/run_file.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/study/interpolation.hpp"
#include "common/at_rate.hpp"

namespace coast::jobs {

/// The trajectory files written by a run.
[[nodiscard]] std::vector<std::string> trajectory_files(const OutputOptions& options);

/// A streamed trajectory at the configured rate, for the configured point of the body, with rates and accelerations.
class TrajectoryOutput {
 public:
  TrajectoryOutput(const OutputOptions& options, record::EpochSink to)
      : options_(options), to_(std::move(to)), rate_(options.rate_hz) {}
  void add(const record::TrajectoryEpoch& epoch);

 private:
  const OutputOptions& options_;
  record::EpochSink to_;
  study::PassingMotion motion_;
  study::PassingMotion motion_at_point_;
  AtRate rate_;
};

}  // namespace coast::jobs
