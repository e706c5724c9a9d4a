#pragma once
// Two trajectories: N, E, D and attitude differences, first minus second.

#include <filesystem>
#include <string>
#include <vector>

#include "coast/jobs/job.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/study/comparison.hpp"

namespace coast::jobs {

struct ComparisonConfig {
  std::filesystem::path first, second;                    ///< .nav, CSV or SBET; differences are at the second's epochs
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the first's point to the second's, m
};

struct ComparisonResult {
  bool has_velocity = false, has_attitude = false;  ///< of both
  std::vector<study::ErrorSample> differences;
  study::ErrorSummary summary;
};
/// @throws InputError  no epoch in common
[[nodiscard]] ComparisonResult compare(const ComparisonConfig& config, const Progress& progress);
/// The same for trajectories in memory.
[[nodiscard]] ComparisonResult compare(const record::Trajectory& first, const record::Trajectory& second,
                                       const Eigen::Vector3d& lever_arm_b);

[[nodiscard]] std::vector<std::string> files_of(const ComparisonConfig& config);
/// differences.csv, comparison.json.
void write(const ComparisonConfig& config, const ComparisonResult& result, const std::filesystem::path& folder);
[[nodiscard]] std::string told(const ComparisonConfig& config, const ComparisonResult& result,
                               const std::filesystem::path& folder);

}  // namespace coast::jobs
