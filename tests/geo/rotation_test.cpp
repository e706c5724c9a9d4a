#include "coast/geo/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coast/geo/units.hpp"
#include "support/support.hpp"

namespace coast::geo {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// exp of a matrix by its power series after scaling: no code shared with Rodrigues' formula.
Matrix3d exponential(const Matrix3d& m) {
  constexpr int kHalvings = 8;
  const Matrix3d small = m / std::pow(2.0, kHalvings);
  Matrix3d term = Matrix3d::Identity();
  Matrix3d sum = Matrix3d::Identity();
  for (int k = 1; k < 20; ++k) {
    term = term * small / k;
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = sum * sum;
  return sum;
}

std::vector<Vector3d> rotation_vectors() {
  std::vector<Vector3d> list = {Vector3d::Zero()};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const double angle :
       {1e-300, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.1, 0.4999, 0.5001, 1.0, 2.0, 3.0, kPi - 1e-6, kPi - 1e-9, kPi}) {
    for (int i = 0; i < 3; ++i) list.push_back(angle * Vector3d(normal(random), normal(random), normal(random)).normalized());
    list.push_back(angle * Vector3d::UnitY());
  }
  return list;
}

TEST(Skew, IsTheCrossProduct) {
  const Vector3d a(1, 2, 3), b(-4, 5, 0.5);
  EXPECT_EQ(skew(a) * b, Vector3d(2 * 0.5 - 3 * 5, 3 * -4 - 1 * 0.5, 1 * 5 - 2 * -4));
}

TEST(Exponential, MatrixAgainstThePowerSeries) {
  for (const Vector3d& v : rotation_vectors()) {
    test::expect_near_matrix(rotation_matrix(v), exponential(skew(v)), 6e-14, "rotation_matrix");  // 8 squarings: 2^8 eps
  }
}

TEST(Exponential, QuaternionIsTheSameRotation) {
  for (const Vector3d& v : rotation_vectors()) {
    const Quaterniond q = quaternion_from_rotation_vector(v);
    EXPECT_NEAR(q.norm(), 1.0, 4e-16);
    test::expect_near_matrix(q.toRotationMatrix(), rotation_matrix(v), 2e-15, "quaternion");
  }
  // 90 degrees about down turns the body's forward axis from north to east.
  EXPECT_LT((quaternion_from_rotation_vector({0, 0, kPi / 2}) * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
}

TEST(Logarithm, InvertsTheExponential) {
  for (const Vector3d& v : rotation_vectors()) {
    const Quaterniond q = quaternion_from_rotation_vector(v);
    const Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
    const double tolerance = 4e-16 * std::max(v.norm(), 1e-300) * 4;
    if (v.norm() < kPi - 1e-10) {
      EXPECT_LT((rotation_vector(q) - v).norm(), tolerance + 1e-315) << v.transpose();
      EXPECT_LT((rotation_vector(minus_q) - v).norm(), tolerance + 1e-315) << v.transpose();
    } else {  // at pi both directions are the same rotation
      EXPECT_LT(std::min((rotation_vector(q) - v).norm(), (rotation_vector(q) + v).norm()), 2e-15);
      EXPECT_LE(rotation_vector(q).norm(), kPi * (1 + 4e-16));
    }
  }
  // A turn of more than pi comes back as the shorter one.
  EXPECT_LT((rotation_vector(quaternion_from_rotation_vector({0, 4.0, 0})) - Vector3d(0, 4.0 - 2 * kPi, 0)).norm(), 2e-15);
}

TEST(RightJacobian, AgainstFiniteDifferences) {
  for (const Vector3d& v : rotation_vectors()) {
    const Quaterniond inverse = quaternion_from_rotation_vector(v).conjugate();
    const auto moved = [&](const Eigen::VectorXd& dv) -> Eigen::VectorXd {
      return rotation_vector(inverse * quaternion_from_rotation_vector(v + Vector3d(dv)));
    };
    // Step 1e-5: truncation 1e-11, rounding 1e-16 / 1e-5.
    test::expect_near_matrix(right_jacobian(v), test::finite_difference(moved, 3, 1e-5), 2e-10, "right_jacobian");
    test::expect_near_matrix(inverse_right_jacobian(v) * right_jacobian(v), Matrix3d::Identity(), 2e-14, "inverse");
  }
}

TEST(RightJacobian, SeriesMeetsTheClosedForm) {
  // On both sides of 0.5 rad, where the evaluation changes; the derivative by the angle is below 1.
  for (const Vector3d& u : {Vector3d::UnitX().eval(), Vector3d(1, -2, 0.5).normalized()}) {
    const double step = 1e-13;
    test::expect_near_matrix(right_jacobian((0.5 - step) * u), right_jacobian((0.5 + step) * u), 5e-13, "right_jacobian");
    test::expect_near_matrix(inverse_right_jacobian((0.5 - step) * u), inverse_right_jacobian((0.5 + step) * u), 5e-13,
                             "inverse");
  }
}

std::vector<Euler> attitudes() {
  std::vector<Euler> list = {{0, 0, 0},   {0.1, -0.2, 3.0},   {-3.0, 1.2, -3.1},    {kPi, 0, 0},
                             {0, 0, kPi}, {1.0, 1.5707, 2.0}, {0.3, -1.5707, -2.0}, {1e-9, 1e-9, 1e-9}};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) list.push_back({kPi * unit(random), 1.5 * unit(random), kPi * unit(random)});
  return list;
}

TEST(EulerAngles, AreTheProductOfThreeTurns) {
  for (const Euler& e : attitudes()) {
    const Matrix3d expected =
        exponential(skew({0, 0, e.yaw})) * exponential(skew({0, e.pitch, 0})) * exponential(skew({e.roll, 0, 0}));
    test::expect_near_matrix(dcm_from_euler(e), expected, 5e-14, "dcm_from_euler");
    test::expect_near_matrix(quaternion_from_euler(e).toRotationMatrix(), expected, 5e-14, "quaternion_from_euler");
  }
}

TEST(EulerAngles, RoundTrip) {
  for (const Euler& e : attitudes()) {
    const double tolerance = 2e-15 / std::cos(e.pitch) + 2e-15;  // roll and yaw are known to eps / cos(pitch)
    const Euler dcm = euler_from_dcm(dcm_from_euler(e));
    const Euler quaternion = euler_from_quaternion(quaternion_from_euler(e));
    for (const Euler& back : {dcm, quaternion}) {
      EXPECT_NEAR(wrap_angle(back.roll - e.roll), 0.0, tolerance);
      EXPECT_NEAR(back.pitch, e.pitch, tolerance);
      EXPECT_NEAR(wrap_angle(back.yaw - e.yaw), 0.0, tolerance);
    }
  }
}

TEST(EulerAngles, GimbalLock) {
  for (const double pitch : {kPi / 2, -kPi / 2}) {
    const Matrix3d C = dcm_from_euler({0.4, pitch, 1.1});
    const Euler e = euler_from_dcm(C);
    EXPECT_EQ(e.roll, 0.0);
    EXPECT_NEAR(e.pitch, pitch, 1e-15);
    EXPECT_NEAR(e.yaw, pitch > 0 ? 1.1 - 0.4 : 1.1 + 0.4, 1e-15);
  }
  // Close to it the angles are poorly known one by one, but the rotation they make is the given one.
  for (const double off : {1e-15, 1e-11, 1e-9, 1e-7}) {
    const Matrix3d C = dcm_from_euler({-2.0, kPi / 2 - off, 0.7});
    test::expect_near_matrix(dcm_from_euler(euler_from_dcm(C)), C, 2e-12, "rotation near gimbal lock");
  }
}

TEST(EulerAngles, RangesAreHalfOpen) {
  EXPECT_EQ(euler_from_dcm(dcm_from_euler({-kPi, 0, 0})).roll, kPi);
  EXPECT_EQ(euler_from_dcm(Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix()).yaw, kPi);
}

TEST(EulerAngles, JacobianAgainstFiniteDifferences) {
  for (const Euler& e : attitudes()) {
    if (std::abs(e.pitch) > 1.55) continue;  // the second derivative grows with tan^2
    const Matrix3d C = dcm_from_euler(e);
    const auto moved = [&](const Eigen::VectorXd& psi) -> Eigen::VectorXd {
      const Euler m = euler_from_dcm(rotation_matrix(psi) * C);
      return Vector3d(wrap_angle(m.roll - e.roll), m.pitch - e.pitch, wrap_angle(m.yaw - e.yaw));
    };
    test::expect_near_matrix(euler_jacobian(e), test::finite_difference(moved, 3, 1e-6), 1e-7, "euler_jacobian");
  }
  EXPECT_TRUE(euler_jacobian({0.1, kPi / 2, 0.2}).allFinite());
}

TEST(Orthonormalised, IsThePolarFactor) {
  const Matrix3d R = dcm_from_euler({0.3, -0.8, 2.0});
  Matrix3d stretch;
  stretch << 1.1, 0.1, -0.05, 0.1, 0.9, 0.02, -0.05, 0.02, 1.3;  // symmetric, positive definite
  test::expect_near_matrix(orthonormalised(R * stretch), R, 1e-14, "polar factor");
}

TEST(WrapAngle, HalfOpenInterval) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.5 * kPi), -0.5 * kPi, 1e-14);
  EXPECT_NEAR(wrap_angle(-7.0), -7.0 + 2 * kPi, 1e-14);
  EXPECT_EQ(wrap_angle(0.25), 0.25);
}

}  // namespace
}  // namespace coast::geo
