#pragma once
// The receiver's own solution: PVTGeodetic and PVTCartesian of SBF. Private to the room.

#include <Eigen/Core>
#include <optional>

#include "../frames/frame.hpp"
#include "coast/record/gnss.hpp"

namespace coast::io {

struct SbfSolution {
  /// Type of solution of 4.2.10: 0 none, 1 stand-alone, 2 differential, 3 fixed location, 4 fixed, 5 float, 6 SBAS, 7 and 8
  /// fixed and float to a moving base, 10 PPP.
  int type = 0;
  int error = 0;
  bool height_held = false;               ///< two-dimensional
  std::optional<Eigen::Vector3d> r_ea_e;  ///< of the marker
  std::optional<Eigen::Vector3d> v_ea_n;  ///< north, east, down
  double clock_bias_s = 0.0;              ///< receiver's clock minus GPS time; 0 if not known
  int datum = 0;                          ///< 0: WGS 84
  int satellites = 0;
  std::optional<Eigen::Matrix3d> position_cov_n;  ///< by the accuracies of the block

  /// A position in three dimensions.
  [[nodiscard]] bool three_dimensional() const { return type != 0 && error == 0 && !height_held && r_ea_e.has_value(); }
  /// A measurement of the receiver itself: neither coordinates that a user has entered nor relative to a base that moves.
  [[nodiscard]] bool measured() const;
  [[nodiscard]] record::FixQuality quality() const;
};

/// None for other blocks, and for one that is too short.
[[nodiscard]] std::optional<SbfSolution> sbf_solution(const MessageFrame& frame);

}  // namespace coast::io
