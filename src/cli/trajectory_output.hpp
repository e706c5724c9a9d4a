#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "coast/io/writers.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/study/interpolation.hpp"
#include "run_config.hpp"

namespace coast::cli {

/// The files of the trajectory that a run writes.
[[nodiscard]] std::vector<std::string> trajectory_files(const OutputOptions& options);
/// Height of the geoid above what the trajectory's heights count from, where that is known, m.
[[nodiscard]] std::optional<double> geoid_height(const RunConfig& config);

/// Writes a streamed trajectory to several files, at the wanted rate and for the wanted point of the body.
class TrajectoryOutput {
 public:
  explicit TrajectoryOutput(const OutputOptions& options) : options_(options) {}
  void add_writer(std::unique_ptr<io::TrajectoryWriter> writer) { writers_.push_back(std::move(writer)); }
  void add(const record::TrajectoryEpoch& epoch);
  void close();

 private:
  const OutputOptions& options_;
  std::vector<std::unique_ptr<io::TrajectoryWriter>> writers_;
  study::PassingMotion motion_;
  study::PassingMotion motion_at_point_;
  std::optional<geo::GpsTime> last_written_;
};

}  // namespace coast::cli
