#pragma once
// Angles of photogrammetry.

#include <Eigen/Core>

namespace coast::geo {

/// Rotation from image axes (x to the right in the image, y to its top, z against the viewing direction) to east-north-up,
/// rad: Rx(omega) Ry(phi) Rz(kappa). A camera that looks straight down with the top of its image to the north has zeros.
struct OmegaPhiKappa {
  double omega = 0.0;  ///< (-pi, pi]
  double phi = 0.0;    ///< [-pi/2, pi/2]
  double kappa = 0.0;  ///< (-pi, pi]
};

/// @param C_s_n  attitude of the camera: s is forward-right-down with forward to the top of the image and down along the view
/// At phi = +-90 deg omega and kappa are not separable: omega is set to 0 and kappa is the sum.
/// @see  Baeumker and Heimes (2001), New calibration and computing method for direct georeferencing, the same angles
[[nodiscard]] OmegaPhiKappa omega_phi_kappa_from_dcm(const Eigen::Matrix3d& C_s_n);
/// d(omega, phi, kappa)/d(psi_n) for C(est) = (I + [psi_n x]) C(truth), psi_n in north-east-down, rad/rad. Singular at
/// phi = +-90 deg: capped there as `euler_jacobian`.
[[nodiscard]] Eigen::Matrix3d omega_phi_kappa_jacobian(const OmegaPhiKappa& angles);

}  // namespace coast::geo
