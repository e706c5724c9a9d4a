#include "coast/study/manoeuvre.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::study {

namespace {

constexpr double kStep = 1.0;        // s
constexpr double kShortest = 3.0;    // s
constexpr double kStanding = 0.2;    // m/s
constexpr double kMoving = 0.5;      // m/s; below it a course is noise
constexpr double kTurning = 3.0;     // deg/s
constexpr double kSpeedingUp = 0.5;  // m/s^2

/// Horizontal velocities of consecutive seconds, N and E; runs end where positions are missing.
std::vector<std::vector<Eigen::Vector2d>> velocities(const record::Trajectory& trajectory, geo::GpsTime from, geo::GpsTime to) {
  std::vector<std::vector<Eigen::Vector2d>> runs(1);
  std::optional<record::NavState> previous;
  const double span = to - from;
  for (int k = 0; k * kStep <= span + 1e-6; ++k) {
    const std::optional<record::NavState> now = state_at(trajectory, from + k * kStep);
    if (now && previous) {
      const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(now->r_eb_e)).transpose();
      runs.back().emplace_back((C_e_n * (now->r_eb_e - previous->r_eb_e)).head<2>() / kStep);
    } else if (!runs.back().empty()) {
      runs.emplace_back();
    }
    previous = now;
  }
  return runs;
}

}  // namespace

std::string_view name(Manoeuvre manoeuvre) {
  constexpr std::array<std::string_view, 4> kNames{"static", "straight", "accelerating", "turn"};
  return kNames[static_cast<std::size_t>(manoeuvre)];
}

Manoeuvre manoeuvre_of(const record::Trajectory& trajectory, geo::GpsTime from, geo::GpsTime to) {
  const double missing = std::max(0.0, kShortest - (to - from));
  from = from - 0.5 * missing;
  to = to + 0.5 * missing;
  double fastest = 0.0;
  double turned = 0.0;
  double turning = 0.0;  // s
  double squares = 0.0;
  std::size_t changes = 0;
  for (const std::vector<Eigen::Vector2d>& run : velocities(trajectory, from, to))
    for (std::size_t i = 0; i < run.size(); ++i) {
      const double speed = run[i].norm();
      fastest = std::max(fastest, speed);
      if (i == 0) continue;
      const Eigen::Vector2d& before = run[i - 1];
      squares += std::pow((speed - before.norm()) / kStep, 2);
      ++changes;
      if (speed < kMoving || before.norm() < kMoving) continue;
      turned += std::abs(std::atan2(before.x() * run[i].y() - before.y() * run[i].x(), before.dot(run[i])));
      turning += kStep;
    }
  if (changes == 0) return Manoeuvre::kStraight;
  if (fastest < kStanding) return Manoeuvre::kStatic;
  if (turning > 0.0 && turned / turning >= kTurning * geo::kDegree) return Manoeuvre::kTurn;
  return std::sqrt(squares / static_cast<double>(changes)) >= kSpeedingUp ? Manoeuvre::kAccelerating : Manoeuvre::kStraight;
}

}  // namespace coast::study
