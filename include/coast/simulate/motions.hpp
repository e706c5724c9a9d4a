#pragma once
// The motions available to scenarios: one file each under src/simulate/motions, one line each in the table.

#include <string>
#include <string_view>
#include <vector>

#include "coast/simulate/trajectory.hpp"

namespace coast::simulate {

/// Parameters of every motion.
struct MotionParameters {
  geo::Geodetic origin;
  double duration = 900.0;     ///< s
  double static_start = 60.0;  ///< s at rest before anything moves
  double course = 0.0;         ///< rad, initial course from north
};

struct MotionKind {
  std::string_view name;  ///< `trajectory.kind`
  std::string_view help;
  double shortest;  ///< s, without the static start
  MotionPlan (*make)(const MotionParameters& parameters);
};

/// All motions, in the order of the manual.
[[nodiscard]] const std::vector<MotionKind>& motions();
/// @throws std::invalid_argument  unknown name; duration below `shortest` plus the static start, or above 1e5 s;
///                                static start negative
[[nodiscard]] AnalyticTrajectory make_motion(std::string_view kind, const MotionParameters& parameters);

}  // namespace coast::simulate
