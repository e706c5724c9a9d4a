#include "coast/geo/photogrammetry.hpp"

#include <algorithm>
#include <cmath>

#include "coast/geo/rotation.hpp"

namespace coast::geo {

namespace {

/// North-east-down to east-north-up, and forward-right-down to the axes of an image: the first two exchanged, the third turned.
Eigen::Matrix3d exchanged() {
  Eigen::Matrix3d T;
  T << 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
  return T;
}

}  // namespace

OmegaPhiKappa omega_phi_kappa_from_dcm(const Eigen::Matrix3d& C_s_n) {
  constexpr double kGimbal = 1e-12;  // cos(phi); below it omega is rounding noise
  const Eigen::Matrix3d C = exchanged() * C_s_n * exchanged();
  OmegaPhiKappa angles;
  const double cos_phi = std::hypot(C(1, 2), C(2, 2));
  angles.phi = std::atan2(C(0, 2), cos_phi);
  angles.omega = cos_phi < kGimbal ? 0.0 : wrap_angle(std::atan2(-C(1, 2), C(2, 2)));
  // Kappa from Rx(-omega) C = Ry Rz: near the pole it includes the error of omega, so the product remains the given rotation.
  const double so = std::sin(angles.omega), co = std::cos(angles.omega);
  angles.kappa = wrap_angle(std::atan2(co * C(1, 0) + so * C(2, 0), co * C(1, 1) + so * C(2, 1)));
  return angles;
}

Eigen::Matrix3d omega_phi_kappa_jacobian(const OmegaPhiKappa& angles) {
  // psi = e_x d(omega) + Rx e_y d(phi) + Rx Ry e_z d(kappa) in east-north-up, solved for the three angles.
  constexpr double kSmallestCosine = 1e-6;
  const double cp = std::max(std::cos(angles.phi), kSmallestCosine);
  const double tp = std::sin(angles.phi) / cp;
  const double so = std::sin(angles.omega), co = std::cos(angles.omega);
  Eigen::Matrix3d J;
  J << 1.0, so * tp, -co * tp,  //
      0.0, co, so,              //
      0.0, -so / cp, co / cp;
  return J * exchanged();
}

}  // namespace coast::geo
