#include "coast/study/interpolation.hpp"

#include <algorithm>

#include "coast/geo/rotation.hpp"

namespace coast::study {

namespace {

// Difference of the positions from the integral of the mean velocity: dt^3 / 12 times the jerk.
Eigen::Vector3d step_beyond_velocity(const record::NavState& a, const record::NavState& b) {
  return b.r_eb_e - a.r_eb_e - 0.5 * (b.t - a.t) * (a.v_eb_e + b.v_eb_e);
}

}  // namespace

bool corrected_between(const record::NavState& a, const record::NavState& b) {
  constexpr double kJerk = 50.0;    // m/s^3
  constexpr double kDigits = 2e-9;  // m: rounding of coordinates from the centre of the Earth
  const double dt = b.t - a.t;
  return step_beyond_velocity(a, b).norm() > kJerk * dt * dt * dt / 12.0 + kDigits;
}

record::NavState interpolate(const record::NavState& a, const record::NavState& b, geo::GpsTime t, bool has_velocity) {
  const double dt = b.t - a.t;
  const double s = dt > 0.0 ? (t - a.t) / dt : 0.0;
  record::NavState nav;
  nav.t = t;
  nav.q_b_e = a.q_b_e.slerp(s, b.q_b_e);
  if (!has_velocity || !(dt > 0.0)) {
    nav.r_eb_e = (1.0 - s) * a.r_eb_e + s * b.r_eb_e;
    nav.v_eb_e = (1.0 - s) * a.v_eb_e + s * b.v_eb_e;
    return nav;
  }
  const double s2 = s * s;
  const double s3 = s2 * s;
  nav.r_eb_e = (1.0 - 3.0 * s2 + 2.0 * s3) * a.r_eb_e + (3.0 * s2 - 2.0 * s3) * b.r_eb_e +
               dt * ((s - 2.0 * s2 + s3) * a.v_eb_e + (s3 - s2) * b.v_eb_e);
  nav.v_eb_e = (1.0 - s) * a.v_eb_e + s * b.v_eb_e;  // the cubic's derivative equals this plus the remainder
  if (!corrected_between(a, b)) nav.v_eb_e += (6.0 / dt) * (s - s2) * step_beyond_velocity(a, b);
  return nav;
}

std::optional<record::NavState> state_at(const record::Trajectory& trajectory, geo::GpsTime t, double longest_gap_s) {
  const auto& states = trajectory.states;
  const auto after = std::lower_bound(states.begin(), states.end(), t,
                                      [](const record::NavState& nav, geo::GpsTime time) { return nav.t < time; });
  if (after == states.end()) return std::nullopt;
  if (after->t == t) return *after;
  if (after == states.begin()) return std::nullopt;
  const auto before = after - 1;
  if (after->t - before->t > longest_gap_s) return std::nullopt;
  return interpolate(*before, *after, t, trajectory.has_velocity);
}

record::NavState at_point(const record::NavState& nav, const Eigen::Vector3d& l_b, const Eigen::Vector3d& omega_eb_b) {
  record::NavState moved = nav;
  moved.r_eb_e += nav.q_b_e * l_b;
  moved.v_eb_e += nav.q_b_e * omega_eb_b.cross(l_b);
  return moved;
}

Eigen::Vector3d mean_rate(const record::NavState& a, const record::NavState& b) {
  const double dt = b.t - a.t;
  if (!(dt > 0.0)) return Eigen::Vector3d::Zero();
  return geo::rotation_vector(a.q_b_e.conjugate() * b.q_b_e) / dt;
}

Eigen::Vector3d mean_acceleration(const record::NavState& a, const record::NavState& b) {
  const double dt = b.t - a.t;
  if (!(dt > 0.0)) return Eigen::Vector3d::Zero();
  return a.q_b_e.slerp(0.5, b.q_b_e).conjugate() * ((b.v_eb_e - a.v_eb_e) / dt);
}

const record::BodyMotion& PassingMotion::at(const record::NavState& nav) {
  if (previous_) {
    held_ = !held_ && corrected_between(*previous_, nav);  // vibration looks like a correction: not held twice in a row
    if (!held_) motion_ = {mean_rate(*previous_, nav), mean_acceleration(*previous_, nav)};
  }
  previous_ = nav;
  return motion_;
}

}  // namespace coast::study
