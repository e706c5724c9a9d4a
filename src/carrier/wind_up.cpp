#include "coast/carrier/wind_up.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "coast/carrier/orbits.hpp"

namespace coast::carrier {

namespace {

/// Effective dipole D = x - k (k x) + k x y of a receiver whose dipoles point forward and left; k: from the satellite.
Eigen::Vector3d receiving_dipole(const Eigen::Vector3d& k, const Eigen::Matrix3d& C_b_e) {
  const Eigen::Vector3d x = C_b_e.col(0);
  return x - k * k.dot(x) - k.cross(C_b_e.col(1));
}

/// Angle about k from one dipole to the other, both normal to k, cycles. Wu et al. have sign(k (a x b)) acos(a b / |a| |b|),
/// which loses half of the digits near 0.
double turn(const Eigen::Vector3d& k, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return std::atan2(k.dot(from.cross(to)), from.dot(to)) / (2.0 * std::numbers::pi);
}

}  // namespace

double wind_up(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_sun_e, const Eigen::Vector3d& r_receiver_e,
               const Eigen::Matrix3d& C_b_e, double previous) {
  const Eigen::Matrix3d satellite = yaw_steering_axes(r_satellite_e, r_sun_e);
  const Eigen::Vector3d k = (r_receiver_e - r_satellite_e).normalized();
  const Eigen::Vector3d sent = satellite.col(0) - k * k.dot(satellite.col(0)) - k.cross(satellite.col(1));
  const double cycles = turn(k, sent, receiving_dipole(k, C_b_e));
  return cycles + std::round(previous - cycles);
}

double wind_up_by_tilt(const Eigen::Vector3d& to_satellite_e, const Eigen::Vector3d& up_e, const Eigen::Matrix3d& C_b_e) {
  const Eigen::Quaterniond upright = Eigen::Quaterniond::FromTwoVectors(-C_b_e.col(2), up_e);
  const Eigen::Vector3d k = -to_satellite_e;
  return turn(k, receiving_dipole(k, upright.toRotationMatrix() * C_b_e), receiving_dipole(k, C_b_e));
}

}  // namespace coast::carrier
