#pragma once
// Rotations. C_a_b takes a to b: v_b = C_a_b * v_a. Quaternions are Hamilton; q_a_b is the same rotation as C_a_b.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace coast::geo {

/// Euler angles z-y-x of C_b_n, rad: C_b_n = Rz(yaw) Ry(pitch) Rx(roll). Used only in files and for display.
struct Euler {
  double roll = 0.0;   ///< (-pi, pi]
  double pitch = 0.0;  ///< [-pi/2, pi/2]
  double yaw = 0.0;    ///< (-pi, pi]
};

/// [v x], so that skew(a) * b = a x b.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Quaternion of the rotation vector (exponential map); full precision for |v| -> 0.
[[nodiscard]] Eigen::Quaterniond quaternion_from_rotation_vector(const Eigen::Vector3d& v);
/// Rotation vector of a unit quaternion (logarithm), norm in [0, pi]; full precision near 0 and near pi.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q);
/// exp([v x]), Rodrigues' formula with its limits for small angles.
[[nodiscard]] Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& v);
/// Right Jacobian of the exponential: exp(v + dv) = exp(v) exp(Jr(v) dv) to first order.
[[nodiscard]] Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& v);
/// Inverse of the right Jacobian (Bortz' equation: d(phi)/dt = Jr^-1(phi) omega with body rates).
[[nodiscard]] Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& v);

[[nodiscard]] Eigen::Matrix3d dcm_from_euler(const Euler& e);
[[nodiscard]] Eigen::Quaterniond quaternion_from_euler(const Euler& e);
/// At pitch = +-90 deg roll and yaw are not separable: roll is set to 0 and yaw is the sum.
[[nodiscard]] Euler euler_from_dcm(const Eigen::Matrix3d& C_b_n);
[[nodiscard]] Euler euler_from_quaternion(const Eigen::Quaterniond& q_b_n);
/// d(roll, pitch, yaw)/d(psi_n) for C(est) = (I + [psi_n x]) C(truth), rad/rad. Singular at pitch +-90 deg: rows capped there.
[[nodiscard]] Eigen::Matrix3d euler_jacobian(const Euler& e);
/// Closest rotation to a nearly orthonormal matrix (polar decomposition).
[[nodiscard]] Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& m);
/// Wraps an angle into (-pi, pi].
[[nodiscard]] double wrap_angle(double radians);

}  // namespace coast::geo
