#pragma once
// From RINEX files to positions.

#include <functional>
#include <string>

#include "ppk_config.hpp"

namespace coast::cli {

struct PpkResult {
  carrier::PpkSolution solution;
  carrier::PpkOptions options;                         ///< that it was solved with
  record::GnssRecording fixes;                         ///< of it, as the filter takes them
  Eigen::Vector3d r_base_e = Eigen::Vector3d::Zero();  ///< its antenna, ECEF, m; of the first epoch where it moves
  std::string base_from;                               ///< where that comes from, in words
  std::string rover, base;                             ///< receiver and antenna, in words
  record::Events events;                               ///< of all files and of the solution
};

/// @throws InputError, NumericalError
[[nodiscard]] PpkResult run_ppk(const PpkConfig& config, const std::function<void(double)>& progress);

}  // namespace coast::cli
