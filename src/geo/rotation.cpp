#include "coast/geo/rotation.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "coast/geo/units.hpp"

namespace coast::geo {

namespace {

// Below this angle the power series replace the closed forms, whose differences lose 1/t^2 digits.
constexpr double kSeriesAngle2 = 0.25;  // rad^2

// sin(x) / x; the quotient itself is accurate for any x that does not underflow.
double sinc(double x) {
  return std::abs(x) < 1e-8 ? 1.0 : std::sin(x) / x;
}

// (1 - cos t) / t^2, without the difference.
double one_minus_cos_over_t2(double t) {
  const double s = sinc(0.5 * t);
  return 0.5 * s * s;
}

// (t - sin t) / t^3; series 1/3! - t^2/5! + ..., remainder below 2e-16 at t = 0.5.
double t_minus_sin_over_t3(double t2) {
  if (t2 < kSeriesAngle2) {
    return (1.0 - t2 / 20.0 * (1.0 - t2 / 42.0 * (1.0 - t2 / 72.0 * (1.0 - t2 / 110.0 * (1.0 - t2 / 156.0))))) / 6.0;
  }
  const double t = std::sqrt(t2);
  return (t - std::sin(t)) / (t * t2);
}

// (1 - (t/2) cot(t/2)) / t^2 = sum of |B_2n| t^(2n-2) / (2n)!, remainder below 3e-17 at t = 0.5.
double inverse_jacobian_factor(double t2) {
  if (t2 < kSeriesAngle2) {
    return 1.0 / 12.0 +
           t2 * (1.0 / 720.0 +
                 t2 * (1.0 / 30240.0 + t2 * (1.0 / 1209600.0 + t2 * (1.0 / 47900160.0 + t2 * (691.0 / 1307674368000.0 +
                                                                                              t2 * (1.0 / 74724249600.0))))));
  }
  const double half = 0.5 * std::sqrt(t2);
  return (1.0 - half / std::tan(half)) / t2;
}

}  // namespace

Eigen::Quaterniond quaternion_from_rotation_vector(const Eigen::Vector3d& v) {
  const double half = 0.5 * v.norm();
  const Eigen::Vector3d vec = 0.5 * sinc(half) * v;
  return {std::cos(half), vec.x(), vec.y(), vec.z()};
}

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and -q are one rotation; this one has the smaller angle
  const double n = q.vec().norm();
  if (n < 1e-150) return 2.0 * sign * q.vec();  // n^2 underflows; the angle is 2 n to full precision
  return sign * (2.0 * std::atan2(n, sign * q.w()) / n) * q.vec();
}

Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& v) {
  const double t = v.norm();
  const Eigen::Matrix3d s = skew(v);
  return Eigen::Matrix3d::Identity() + sinc(t) * s + one_minus_cos_over_t2(t) * (s * s);
}

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& v) {
  // Chirikjian (2012), Stochastic Models, Information Theory, and Lie Groups, vol. 2, eq. (10.86).
  const double t2 = v.squaredNorm();
  const Eigen::Matrix3d s = skew(v);
  return Eigen::Matrix3d::Identity() - one_minus_cos_over_t2(std::sqrt(t2)) * s + t_minus_sin_over_t3(t2) * (s * s);
}

Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& v) {
  const Eigen::Matrix3d s = skew(v);
  return Eigen::Matrix3d::Identity() + 0.5 * s + inverse_jacobian_factor(v.squaredNorm()) * (s * s);
}

Eigen::Matrix3d dcm_from_euler(const Euler& e) {
  const double sr = std::sin(e.roll), cr = std::cos(e.roll);
  const double sp = std::sin(e.pitch), cp = std::cos(e.pitch);
  const double sy = std::sin(e.yaw), cy = std::cos(e.yaw);
  Eigen::Matrix3d C_b_n;
  C_b_n << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,       //
      -sp, cp * sr, cp * cr;
  return C_b_n;
}

Eigen::Quaterniond quaternion_from_euler(const Euler& e) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(e.yaw, Vector3d::UnitZ()) * AngleAxisd(e.pitch, Vector3d::UnitY()) * AngleAxisd(e.roll, Vector3d::UnitX());
}

Euler euler_from_dcm(const Eigen::Matrix3d& C_b_n) {
  constexpr double kGimbal = 1e-12;  // cos(pitch); below it roll is rounding noise
  const auto& C = C_b_n;
  Euler e;
  const double cos_pitch = std::hypot(C(2, 1), C(2, 2));
  e.pitch = std::atan2(-C(2, 0), cos_pitch);
  e.roll = cos_pitch < kGimbal ? 0.0 : wrap_angle(std::atan2(C(2, 1), C(2, 2)));
  // Yaw from C Rx(-roll) = Rz Ry: near the pole it includes the error of roll, so the product remains the given rotation.
  const double sr = std::sin(e.roll), cr = std::cos(e.roll);
  e.yaw = wrap_angle(std::atan2(C(0, 2) * sr - C(0, 1) * cr, C(1, 1) * cr - C(1, 2) * sr));
  return e;
}

Euler euler_from_quaternion(const Eigen::Quaterniond& q_b_n) {
  return euler_from_dcm(q_b_n.toRotationMatrix());
}

Eigen::Matrix3d euler_jacobian(const Euler& e) {
  // psi_n = Rz Ry e_x d(roll) + Rz e_y d(pitch) + e_z d(yaw), solved for the three angles.
  constexpr double kSmallestCosine = 1e-6;
  const double cp = std::max(std::cos(e.pitch), kSmallestCosine);
  const double sp = std::sin(e.pitch);
  const double sy = std::sin(e.yaw), cy = std::cos(e.yaw);
  Eigen::Matrix3d J;
  J << cy / cp, sy / cp, 0.0,  //
      -sy, cy, 0.0,            //
      cy * sp / cp, sy * sp / cp, 1.0;
  return J;
}

Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

double wrap_angle(double radians) {
  const double wrapped = std::remainder(radians, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace coast::geo
