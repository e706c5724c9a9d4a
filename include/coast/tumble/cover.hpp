#pragma once
// What a further pose would add to a multi-position calibration.

#include <Eigen/Core>
#include <vector>

#include "coast/tumble/calibration.hpp"

namespace coast::tumble {

/// Information, in nats, that one more rest would add about bias and gain of the accelerometers: half the logarithm of the
/// ratio of the determinants of their covariance before and after (the gain of a D-optimal design).
/// @param up  unit vector, calibrated axes
[[nodiscard]] double information(const Result& result, const Eigen::Vector3d& up);

/// Directions spread evenly over the sphere (Fibonacci's spiral).
[[nodiscard]] std::vector<Eigen::Vector3d> directions(std::size_t count);

struct Proposal {
  Eigen::Vector3d up;
  double information = 0.0;      ///< nats
  double largest_gain_sd = 0.0;  ///< of the gains xx to yz, with this pose and those before it
};
/// The most informative further poses, one after the other, each with those before it.
[[nodiscard]] std::vector<Proposal> proposals(const Result& result, std::size_t count);

}  // namespace coast::tumble
