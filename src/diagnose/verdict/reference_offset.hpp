#pragma once
// A common offset of all positions, observable only with a reference; private to the room.

#include <vector>

#include "coast/diagnose/diagnosis.hpp"

namespace coast::diagnose {

/// Offset of a smoothed trajectory from a reference, N, E, D, m.
struct ReferenceOffset {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();       ///< by the spread from minute to minute
  Eigen::Vector3d p_value = Eigen::Vector3d::Ones();  ///< that the largest of the three is as large by chance
  Eigen::Vector3d ratio = Eigen::Vector3d::Zero();    ///< likelihood ratio of equal probability with one degree of freedom
};
/// None if they have less than five minutes in common.
[[nodiscard]] std::optional<ReferenceOffset> offset_from(const Reference& reference, const std::vector<record::NavState>& path);

/// Reports the offset as base_coordinate_offset if it is significant, otherwise the detectable one.
void tell_offset(const ReferenceOffset& offset, Diagnosis& diagnosis);

}  // namespace coast::diagnose
