#pragma once
// Analytic motion of a body over the Earth: position, velocity, attitude, rate and specific force at any instant.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/simulate/signal.hpp"

namespace coast::simulate {

/// How the attitude follows the path, besides the yaw that follows the course and the pitch that follows the slope:
///
///     roll = atan(bank v course' / g),   pitch = slope + atan(lift v' / g)
///
/// bank = 1: coordinated turn; -0.1: a car that leans outward. lift = -1: a multicopter that tilts to accelerate.
struct AttitudeRule {
  double bank = 0.0;
  double lift = 0.0;
};

/// A named part of a motion, such as its roundabout, where an outage is most informative.
struct Manoeuvre {
  std::string name;
  double start = 0.0;     ///< s since the start of the motion
  double duration = 0.0;  ///< s
};

/// A motion: speed along a path of given course and slope, small displacements about it, and the attitude.
/// Speed, course and slope are functions of time; the position is their integral, so course and attitude are defined at
/// standstill as well. Everything is analytic; a start at rest is exactly at rest.
struct MotionPlan {
  geo::Geodetic origin;   ///< start of the path
  double duration = 0.0;  ///< s, > 0
  Signal speed;           ///< m/s, along the path
  Signal course;          ///< rad, from the path frame's north
  Signal slope;           ///< rad, positive up
  Signal ahead;           ///< m, displacement from the path: along the course, horizontal
  Signal right;           ///< m, across the course, horizontal
  Signal down;            ///< m
  Signal roll;            ///< rad, added to the rule
  Signal pitch;           ///< rad, added to slope and rule
  Signal yaw;             ///< rad, added to the course
  AttitudeRule rule;
  std::vector<Manoeuvre> manoeuvres;
};

/// Motion of a body point at an instant, relative to the Earth.
struct Kinematics {
  double t = 0.0;          ///< s since the start of the motion
  Eigen::Vector3d r_eb_e;  ///< m
  Eigen::Vector3d v_eb_e;  ///< dr/dt, m/s
  Eigen::Vector3d a_eb_e;  ///< d2r/dt2, m/s^2
  Eigen::Matrix3d C_b_e;
  Eigen::Vector3d omega_eb_b;  ///< rad/s
  Eigen::Vector3d alpha_eb_b;  ///< time derivative of the components of omega_eb_b, rad/s^2
};

/// Motion of another point of the same rigid body, at l_b [m, body axes].
[[nodiscard]] Kinematics at_point(const Kinematics& body, const Eigen::Vector3d& l_b);
/// Rate relative to inertial space: omega_eb_b + C_e_b omega_ie_e [rad/s].
[[nodiscard]] Eigen::Vector3d omega_ib_b(const Kinematics& body);
/// Specific force C_e_b (a_eb_e + 2 omega_ie_e x v_eb_e - g_e(r)), normal gravity of WGS 84 [m/s^2].
[[nodiscard]] Eigen::Vector3d f_ib_b(const Kinematics& body);

/// The motion of a plan. The path is laid on the sphere that touches the ellipsoid at the origin (radius sqrt(M N) plus
/// the origin's height), by stereographic projection from the tangent plane: conformal, so the velocity has the stated course,
/// and without singularities, also at the poles. Path axes p (north-east-down of that sphere, north by the projection) agree
/// with n at the origin; away from it they differ by the meridian convergence, and from the plumb line by about 5e-6 rad at 10
/// km. Position is consistent with velocity to 1e-9 m.
class AnalyticTrajectory {
 public:
  /// @throws std::invalid_argument duration not positive, or above 2e5 s
  explicit AnalyticTrajectory(MotionPlan plan);

  /// @param t s since the start, within one second of [0, duration]  @throws std::invalid_argument outside
  [[nodiscard]] Kinematics at(double t) const;
  [[nodiscard]] double duration() const { return plan_.duration; }
  [[nodiscard]] const MotionPlan& plan() const { return plan_; }
  /// True attitude, position and velocity as a record.  @param start the time of t = 0
  [[nodiscard]] record::NavState nav_state(geo::GpsTime start, double t) const;

 private:
  /// Integrals of the path's velocity, one Chebyshev series per channel and segment.
  static constexpr std::size_t kNodes = 16;
  struct Segment {
    double integral[3][kNodes + 1];  ///< north, east, height: coefficients in T_k, with the constant of integration
  };
  void integrate_path();
  [[nodiscard]] std::array<double, 3> path_position(double t) const;

  MotionPlan plan_;
  std::vector<Segment> segments_;
  Eigen::Matrix3d C_p0_e_;  // path axes at the origin
  Eigen::Vector3d origin_e_;
  double radius_ = 0.0;  // m
};

}  // namespace coast::simulate
