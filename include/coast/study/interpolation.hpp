#pragma once

#include <optional>

#include "coast/record/trajectory.hpp"

namespace coast::study {

/// State between two epochs at t in [a.t, b.t]: position by the cubic through both positions and velocities, velocity by that
/// cubic's derivative blended to the ends, attitude along the shortest rotation. Without velocities position is linear.
/// Position error below max|d4 r/dt4| dt^4 / 384.
[[nodiscard]] record::NavState interpolate(const record::NavState& a, const record::NavState& b, geo::GpsTime t,
                                           bool has_velocity = true);

/// The trajectory at an instant; nothing outside it and inside gaps longer than `longest_gap_s`.
[[nodiscard]] std::optional<record::NavState> state_at(const record::Trajectory& trajectory, geo::GpsTime t,
                                                       double longest_gap_s = 2.0);

/// The state of another point of the body: r + C l, v + C (omega x l). @param omega_eb_b rate against the Earth, rad/s
[[nodiscard]] record::NavState at_point(const record::NavState& nav, const Eigen::Vector3d& l_b,
                                        const Eigen::Vector3d& omega_eb_b);
/// Mean rate against the Earth between two epochs, body axes, rad/s.
[[nodiscard]] Eigen::Vector3d mean_rate(const record::NavState& a, const record::NavState& b);

}  // namespace coast::study
