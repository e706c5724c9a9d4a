#pragma once

#include <optional>

#include "coast/record/trajectory.hpp"

namespace coast::study {

/// State between two epochs at t in [a.t, b.t]: position by the cubic through both positions and velocities, velocity by that
/// cubic's derivative, blended to match both ends, attitude along the shortest rotation. Without velocities position is linear.
/// Position error below max|d4 r/dt4| dt^4 / 384. If a filter update lies between the two, velocity is linear: otherwise it
/// would contain the derivative of the correction step.
[[nodiscard]] record::NavState interpolate(const record::NavState& a, const record::NavState& b, geo::GpsTime t,
                                           bool has_velocity = true);

/// The trajectory at an instant; nothing outside it and inside gaps longer than `longest_gap_s`.
[[nodiscard]] std::optional<record::NavState> state_at(const record::Trajectory& trajectory, geo::GpsTime t,
                                                       double longest_gap_s = 2.0);

/// The state of another point of the body: r + C l, v + C (omega x l). @param omega_eb_b rate relative to the Earth, rad/s
[[nodiscard]] record::NavState at_point(const record::NavState& nav, const Eigen::Vector3d& l_b,
                                        const Eigen::Vector3d& omega_eb_b);
/// Mean rate relative to the Earth between two epochs, body axes, rad/s.
[[nodiscard]] Eigen::Vector3d mean_rate(const record::NavState& a, const record::NavState& b);

/// Mean acceleration relative to the Earth between two epochs, in body axes at the midpoint, m/s^2.
[[nodiscard]] Eigen::Vector3d mean_acceleration(const record::NavState& a, const record::NavState& b);

/// Whether positions and velocities disagree by more than a jerk of 50 m/s^3 explains: then a filter update lies between the
/// two epochs, and their differences are not motion.
[[nodiscard]] bool corrected_between(const record::NavState& a, const record::NavState& b);

/// Motion of a trajectory that is passed in epoch by epoch; across a filter update that of the previous interval.
class PassingMotion {
 public:
  /// @return over the interval that ends there; zero at the first epoch
  const record::BodyMotion& at(const record::NavState& nav);

 private:
  std::optional<record::NavState> previous_;
  record::BodyMotion motion_;
  bool held_ = false;
};

}  // namespace coast::study
