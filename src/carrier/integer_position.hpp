#pragma once
// The position that the integers of one epoch give by themselves. Private to the room.

#include "fixing.hpp"

namespace coast::carrier {

struct IntegerPosition {
  Eigen::VectorXd step;  ///< of the state from the linearisation, with the integers
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();
  double pdop = 0.0;                  ///< of the satellites used, each system with its own clock
  std::vector<Unknown> contradicted;  ///< ambiguities whose integers do not agree with the others
};

/// From the phases that have integers, and nothing else but the delays of the atmosphere: float ambiguities contain codes and
/// reflections of earlier epochs, which do not average out within a street. Integers whose phases do not agree with the others
/// (w-test) are left out.
/// @return its pdop is infinite where the integers do not determine the position; none without phases of other systems than
/// GLONASS, whose integers need the clock of the codes
std::optional<IntegerPosition> integer_position(const DifferenceEpoch& epoch, const FloatEpoch& updated,
                                                const RelativeState& state, const FixedSolution& fixed);

}  // namespace coast::carrier
