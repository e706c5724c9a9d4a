#include "process/page/curves.hpp"

#include <cmath>
#include <vector>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::jobs {

namespace {

constexpr double kFrameReach = 20.0;         // m of motion before the frame is renewed
constexpr double kLongestStep = 1.0;         // s; a longer one interrupts the curves
constexpr double kLeastSpeedOfCourse = 2.0;  // m/s: below it GNSS-grade velocity errors change the course by a degree and more
constexpr std::size_t kMainPoints = 16000;   // 3600 s at 200 Hz: an extreme pair every 0.45 s
constexpr std::size_t kSidePoints = 6000;

report::Decimator decimator(std::size_t points) {
  return report::Decimator({points, kLongestStep});
}
Decimators three(std::size_t points) {
  return {decimator(points), decimator(points), decimator(points)};
}

void add_with_band(Decimators& to, double t, const Eigen::Vector3d& value, const Eigen::Vector3d& sd) {
  for (Eigen::Index i = 0; i < 3; ++i) to[static_cast<std::size_t>(i)].add(t, value(i), value(i) - sd(i), value(i) + sd(i));
}
void add(Decimators& to, double t, const Eigen::Vector3d& value) {
  for (Eigen::Index i = 0; i < 3; ++i) to[static_cast<std::size_t>(i)].add(t, value(i));
}

void add_to_minute(std::vector<MinuteAccuracy>& minutes, double t, const Eigen::Vector3d& sd_position,
                   const Eigen::Vector3d& sd_attitude) {
  constexpr double kMinute = 60.0;  // s
  const double from = kMinute * std::floor(t / kMinute);
  if (minutes.empty() || minutes.back().from_s != from) minutes.push_back({from, sd_position, sd_attitude});
  minutes.back().sd_position = minutes.back().sd_position.cwiseMax(sd_position);
  minutes.back().sd_attitude = minutes.back().sd_attitude.cwiseMax(sd_attitude);
}

}  // namespace

SolutionCurves::SolutionCurves(double start_yaw)
    : position(three(kMainPoints)),
      velocity(three(kMainPoints)),
      attitude(three(kMainPoints)),
      sd_position(three(kSidePoints)),
      sd_velocity(three(kSidePoints)),
      sd_attitude(three(kSidePoints)),
      yaw(start_yaw) {}

void NearbyFrame::move_to(const Eigen::Vector3d& r_e) {
  if (frame_ && frame_->to_ned(r_e).squaredNorm() < kFrameReach * kFrameReach) return;
  const geo::Geodetic here = geo::geodetic_from_ecef(r_e);
  frame_.emplace(here);
  height_ = here.height;
}

TrajectoryCurves::Curves::Curves(const record::NavState& nav)
    : start(nav.t),
      local(geo::geodetic_from_ecef(nav.r_eb_e)),
      start_height(geo::geodetic_from_ecef(nav.r_eb_e).height),
      forward(geo::euler_from_dcm(local.rotation().transpose() * nav.q_b_e.toRotationMatrix()).yaw),
      smoothed(forward.yaw),
      track(decimator(kMainPoints)),
      height(decimator(kMainPoints)),
      distance(decimator(kSidePoints)),
      speed(decimator(kMainPoints)),
      body_velocity(three(kMainPoints)),
      slip(decimator(kMainPoints)) {}

void TrajectoryCurves::Curves::add(const record::TrajectoryEpoch& epoch, SolutionCurves& to) const {
  const record::NavState& nav = epoch.nav;
  to.nearby.move_to(nav.r_eb_e);
  const Eigen::Matrix3d C_e_n = to.nearby.C_e_n();
  const double t = nav.t - start;

  Eigen::Vector3d position_n = local.to_ned(nav.r_eb_e);
  position_n.z() = start_height - to.nearby.height(nav.r_eb_e);
  const Eigen::Vector3d sd_position = epoch.cov.position.diagonal().cwiseSqrt();
  add_with_band(to.position, t, position_n, sd_position);
  jobs::add(to.sd_position, t, sd_position);

  const Eigen::Vector3d sd_velocity = epoch.cov.velocity.diagonal().cwiseSqrt();
  add_with_band(to.velocity, t, C_e_n * nav.v_eb_e, sd_velocity);
  jobs::add(to.sd_velocity, t, sd_velocity);

  const geo::Euler euler = geo::euler_from_dcm(C_e_n * nav.q_b_e.toRotationMatrix());
  to.yaw += geo::wrap_angle(euler.yaw - to.yaw);
  const Eigen::Matrix3d J = geo::euler_jacobian(euler);
  const Eigen::Vector3d sd_attitude = (J * epoch.cov.attitude * J.transpose()).diagonal().cwiseSqrt() / geo::kDegree;
  add_with_band(to.attitude, t, Eigen::Vector3d(euler.roll, euler.pitch, to.yaw) / geo::kDegree, sd_attitude);
  jobs::add(to.sd_attitude, t, sd_attitude);
  add_to_minute(to.minutes, t, sd_position, sd_attitude);
}

void TrajectoryCurves::Curves::add_delivered(const record::TrajectoryEpoch& epoch) {
  const record::NavState& nav = epoch.nav;
  add(epoch, smoothed);
  const double t = nav.t - start;
  const Eigen::Vector3d position_n = local.to_ned(nav.r_eb_e);
  track.add_track(t, position_n.y(), position_n.x());
  height.add(t, smoothed.nearby.height(nav.r_eb_e));

  if (previous) travelled += 0.5 * (nav.v_eb_e.norm() + previous->v_eb_e.norm()) * (nav.t - previous->t);
  distance.add(t, travelled);
  previous = nav;

  const Eigen::Vector3d v_eb_b = nav.q_b_e.conjugate() * nav.v_eb_e;
  jobs::add(body_velocity, t, v_eb_b);
  const Eigen::Vector3d v_eb_n = smoothed.nearby.C_e_n() * nav.v_eb_e;
  const double horizontal = v_eb_n.head<2>().norm();
  speed.add(t, horizontal);
  if (horizontal < kLeastSpeedOfCourse) {
    slip.interrupt();
    return;
  }
  const double course = std::atan2(v_eb_n.y(), v_eb_n.x());
  slip.add(t, geo::wrap_angle(course - smoothed.yaw) / geo::kDegree);
}

TrajectoryCurves::TrajectoryCurves(const record::NavState& start) : curves_(std::make_unique<Curves>(start)) {}
TrajectoryCurves::~TrajectoryCurves() = default;

void TrajectoryCurves::add_forward(const record::TrajectoryEpoch& epoch) {
  curves_->add(epoch, curves_->forward);
}

void TrajectoryCurves::add_smoothed(const record::TrajectoryEpoch& epoch) {
  curves_->add_delivered(epoch);
}

}  // namespace coast::jobs
