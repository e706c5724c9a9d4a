#pragma once
// Strapdown mechanisation in the e-frame from increments.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "coast/geo/earth.hpp"
#include "coast/record/imu.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::ins {

/// Rotation and velocity increment of one IMU interval, without Earth rate and gravity: exact for any motion.
struct BodyIncrement {
  double dt = 0.0;      ///< s
  Eigen::Vector3d phi;  ///< rotation vector with respect to i, from b at the start to b at the end, rad
  Eigen::Vector3d u;    ///< integral of f_ib resolved in b at the *start* of the interval, m/s
};

/// Raw increments over one interval (integrals of rate and specific force in moving body axes).
struct RawIncrement {
  double dt = 0.0;
  Eigen::Vector3d dtheta = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv = Eigen::Vector3d::Zero();
};

/// Coning and sculling from this and the previous interval; intervals may differ in length. Exact for constant rate and force
/// at any turn rate; for rate and force linear in time, to second order in small angles. Without a previous interval (dt = 0)
/// the motion is assumed constant over the interval.
///
///     phi = th + c [th' x th],   u = J(th) dv + c ([th' x dv] + [dv' x th]),   c = T^2 / (6 T' (T + T')),
///     J(th) = integral of exp([th s x]) over s in [0, 1] = I + [th x]/2 + [th x]^2/6 + ...
///
/// Savage (1998) eqs. (33), (52), given there for T = T' (c = 1/12) and with the first two terms of J.
[[nodiscard]] BodyIncrement compensate_two_sample(const RawIncrement& previous, const RawIncrement& current);

/// An interval split at `fraction` in (0, 1) of its length, with rate and force linear over this and the previous interval. The
/// two parts add up to the whole.
struct SplitIncrement {
  RawIncrement first;
  RawIncrement second;
};
[[nodiscard]] SplitIncrement split(const RawIncrement& previous, const RawIncrement& current, double fraction);

/// Navigation equations in e: attitude by the exact rotations of body and Earth, velocity with gravity and Coriolis at the
/// middle of the interval, position by the trapezoidal rule.
///
/// The position error of the trapezoidal rule is T^2/12 times the change of acceleration since the start, however long ago
/// (Euler and Maclaurin): 0.02 mm for 2 m/s^2 at 100 Hz. To run backwards in time, pass -kEarthRate and the output of
/// reversal.hpp. No allocation; a step takes some 0.1 us.
class Strapdown {
 public:
  explicit Strapdown(const record::NavState& start, double earth_rate = geo::kEarthRate);

  void step(const BodyIncrement& increment);

  [[nodiscard]] const record::NavState& state() const { return state_; }
  /// Sets position, velocity and attitude (closed-loop correction by the filter); the time is unchanged.
  void correct(const Eigen::Vector3d& r_eb_e, const Eigen::Vector3d& v_eb_e, const Eigen::Quaterniond& q_b_e);
  /// Sets the time exactly (sums of intervals have rounding errors).
  void set_time(geo::GpsTime t) { state_.t = t; }
  [[nodiscard]] const Eigen::Matrix3d& gravity_gradient() const { return gravity_.gradient(); }
  /// Attitude at the end of the last step.
  [[nodiscard]] const Eigen::Matrix3d& C_b_e() const { return C_b_e_; }
  /// Integral of the specific force resolved in e over the last step [m/s], for the error dynamics.
  [[nodiscard]] const Eigen::Vector3d& last_dv_e() const { return last_dv_e_; }
  [[nodiscard]] double earth_rate() const { return earth_rate_; }

 private:
  record::NavState state_;
  Eigen::Matrix3d C_b_e_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d last_dv_e_ = Eigen::Vector3d::Zero();
  geo::LocalGravity gravity_;
  double earth_rate_;
};

}  // namespace coast::ins
