#include "coast/geo/photogrammetry.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::geo {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

/// The camera turned by hand about axes of east-north-up: heading about up, then pitch and roll about its own axes.
Eigen::Matrix3d image_to_enu(double yaw, double pitch, double roll) {
  const Vector3d up = Vector3d::UnitZ();
  const Eigen::Matrix3d heading = AngleAxisd(-yaw, up).toRotationMatrix();  // clockwise from north
  const Vector3d right = heading * Vector3d::UnitX();
  const Eigen::Matrix3d pitched = AngleAxisd(pitch, right) * heading;  // nose up
  const Vector3d forward = pitched * Vector3d::UnitY();
  return AngleAxisd(roll, forward) * pitched;  // right side down
}

Eigen::Matrix3d product(const OmegaPhiKappa& angles) {
  return (AngleAxisd(angles.omega, Vector3d::UnitX()) * AngleAxisd(angles.phi, Vector3d::UnitY()) *
          AngleAxisd(angles.kappa, Vector3d::UnitZ()))
      .toRotationMatrix();
}

TEST(OmegaPhiKappa, IsTheRotationOfACameraThatIsTurnedByHand) {
  for (const double yaw : {-3.0, -0.4, 0.0, 0.7, 2.5})
    for (const double pitch : {-1.2, -0.1, 0.0, 0.3, 1.5})
      for (const double roll : {-2.0, -0.2, 0.0, 0.1, 3.0}) {
        const OmegaPhiKappa angles = omega_phi_kappa_from_dcm(dcm_from_euler({roll, pitch, yaw}));
        EXPECT_LT((product(angles) - image_to_enu(yaw, pitch, roll)).norm(), 1e-14) << yaw << ' ' << pitch << ' ' << roll;
      }
}

TEST(OmegaPhiKappa, OfPlainCases) {
  const auto of = [](double roll, double pitch, double yaw) {
    const OmegaPhiKappa a = omega_phi_kappa_from_dcm(dcm_from_euler({roll * kDegree, pitch * kDegree, yaw * kDegree}));
    return Vector3d(Vector3d(a.omega, a.phi, a.kappa) / kDegree);
  };
  EXPECT_LT((of(0, 0, 0) - Vector3d(0, 0, 0)).norm(), 1e-12);     // straight down, top to the north
  EXPECT_LT((of(0, 0, 90) - Vector3d(0, 0, -90)).norm(), 1e-12);  // top to the east
  EXPECT_LT((of(0, 10, 0) - Vector3d(10, 0, 0)).norm(), 1e-12);   // nose up: looks ahead, to the north
  EXPECT_LT((of(10, 0, 0) - Vector3d(0, 10, 0)).norm(), 1e-12);   // right side down: looks to the left, west
  EXPECT_LT((of(0, 90, 0) - Vector3d(90, 0, 0)).norm(), 1e-12);   // looks to the horizon in the north
}

TEST(OmegaPhiKappa, AtNinetyDegreesTheRotationRemains) {
  for (const double phi : {90.0, -90.0, 90.0 - 1e-9}) {
    const OmegaPhiKappa angles = omega_phi_kappa_from_dcm(dcm_from_euler({phi * kDegree, 0.0, 0.4}));
    EXPECT_LT((product(angles) - image_to_enu(0.4, 0.0, phi * kDegree)).norm(), 1e-10) << phi;
  }
}

TEST(OmegaPhiKappa, JacobianIsThatOfFiniteDifferences) {
  constexpr double kStep = 1e-6;
  for (const double pitch : {-1.0, 0.0, 0.6})
    for (const double roll : {-0.9, 0.0, 0.4}) {
      const Eigen::Matrix3d C_s_n = dcm_from_euler({roll, pitch, 2.1});
      const Eigen::Matrix3d J = omega_phi_kappa_jacobian(omega_phi_kappa_from_dcm(C_s_n));
      for (Eigen::Index i = 0; i < 3; ++i) {
        const Vector3d psi_n = kStep * Vector3d::Unit(i);
        const OmegaPhiKappa plus = omega_phi_kappa_from_dcm(rotation_matrix(psi_n) * C_s_n);
        const OmegaPhiKappa minus = omega_phi_kappa_from_dcm(rotation_matrix(-psi_n) * C_s_n);
        const Vector3d slope =
            Vector3d(plus.omega - minus.omega, plus.phi - minus.phi, plus.kappa - minus.kappa) / (2.0 * kStep);
        EXPECT_LT((J.col(i) - slope).norm(), 1e-8) << pitch << ' ' << roll << ' ' << i;
      }
    }
}

}  // namespace
}  // namespace coast::geo
