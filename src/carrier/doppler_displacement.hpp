#pragma once
// How far the rover has moved since the previous epoch, by Doppler. Private to the room.

#include "coast/carrier/ppk.hpp"

namespace coast::carrier {

/// Mean of two velocities times the time between them.
struct DopplerDisplacement {
  Eigen::Vector3d d_e = Eigen::Vector3d::Zero();           ///< m
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();  ///< m^2, by the noise of the velocities
};

/// @param dt  from the first to the second, s, negative backward in time
DopplerDisplacement doppler_displacement(const SinglePoint::Velocity& first, const SinglePoint::Velocity& second, double dt);

/// Factor on the sd of these displacements: also from what the mean of two velocities does not follow, and from reflected
/// signals. From the differences to successive positions with integers.
/// @return none with too few of them, or where Doppler is useless
std::optional<double> displacement_noise(const std::vector<DifferenceEpoch>& epochs, const std::vector<PpkEpoch>& solved);

}  // namespace coast::carrier
