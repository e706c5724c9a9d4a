#include "motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::io {

namespace {

constexpr double kGrid = 0.05;          // s
constexpr double kMostNodes = 2e6;      // 96 MB; beyond 28 h the grid step is larger
constexpr double kLegLength = 0.45;     // s; in shorter legs course rates are dominated by noise
constexpr double kLongestLeg = 2.5;     // s
constexpr double kLeastMoving = 0.3;    // m/s, horizontal: below it a course is noise
constexpr double kMostMoving = 1.5;     // m/s
constexpr double kMaxShift = 45.0;      // s
constexpr double kShiftStep = 0.1;      // s
constexpr std::size_t kMaxLegs = 3000;  // those with the largest turn rates
constexpr double kLeastTurn = 0.02;     // rad/s
constexpr std::size_t kLeastLegs = 20;

/// Velocity in N, E, D at a fix: as given, else by differences.
Eigen::Vector3d velocity_at(const std::vector<record::GnssFix>& fixes, std::size_t i) {
  if (fixes[i].velocity) return fixes[i].velocity->v_ea_n;
  std::size_t a = i;
  std::size_t b = i;
  while (a > 0 && fixes[i].t - fixes[a].t < kLegLength) --a;
  while (b + 1 < fixes.size() && fixes[b].t - fixes[i].t < kLegLength) ++b;
  if (a == b) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d v_e = (fixes[b].r_ea_e - fixes[a].r_ea_e) / (fixes[b].t - fixes[a].t);
  return geo::C_n_e(geo::geodetic_from_ecef(fixes[i].r_ea_e)).transpose() * v_e;
}

/// Least speed for a valid course: five times the noise of the velocities.
double moving_speed(const record::GnssRecording& gnss) {
  const record::GnssFix& fix = gnss.fixes[gnss.fixes.size() / 2];
  const double sigma =
      fix.velocity ? std::sqrt(fix.velocity->cov_n(0, 0)) : std::sqrt(2.0 * fix.position_cov_n(0, 0)) / (2.0 * kLegLength);
  return std::clamp(5.0 * sigma, kLeastMoving, kMostMoving);
}

}  // namespace

ImuMeans::ImuMeans(const record::ImuRecording& imu) {
  const auto& samples = imu.samples;
  origin_ = samples.front().t - samples.front().dt;
  const double length = samples.back().t - origin_;
  step_ = std::max({kGrid, 1.0 / imu.rate_hz, length / kMostNodes});
  nodes_.reserve(static_cast<std::size_t>(length / step_) + 2);
  nodes_.push_back(Node::Zero());
  Node sum = Node::Zero();
  for (const record::ImuSample& s : samples) {
    const double end = s.t - origin_;
    Node increment;
    increment << s.dtheta, s.dv;
    while (step_ * static_cast<double>(nodes_.size()) <= end) {
      const double missing = end - step_ * static_cast<double>(nodes_.size());
      nodes_.push_back(sum + increment * (1.0 - std::min(1.0, missing / s.dt)));
    }
    sum += increment;
  }
}

ImuMeans::Node ImuMeans::at(double t) const {
  const double x = t / step_;
  const auto i = std::min(static_cast<std::size_t>(x), nodes_.size() - 2);
  const double fraction = x - static_cast<double>(i);
  return nodes_[i] + fraction * (nodes_[i + 1] - nodes_[i]);
}

std::optional<ImuMeans::Mean> ImuMeans::over(double from, double to) const {
  if (from < 0.0 || to > length() || nodes_.size() < 2 || to <= from) return std::nullopt;
  const Node mean = (at(to) - at(from)) / (to - from);
  return Mean{mean.head<3>(), mean.tail<3>()};
}

std::vector<GnssLeg> gnss_legs(const record::GnssRecording& gnss, geo::GpsTime origin) {
  const auto& fixes = gnss.fixes;
  std::vector<GnssLeg> legs;
  if (fixes.size() < 2) return legs;
  const double moving = moving_speed(gnss);
  std::size_t i = 0;
  Eigen::Vector3d v_i = velocity_at(fixes, 0);
  for (std::size_t k = 1; k < fixes.size(); ++k) {
    const double dt = fixes[k].t - fixes[i].t;
    if (dt < kLegLength) continue;
    const Eigen::Vector3d v_k = velocity_at(fixes, k);
    if (dt <= kLongestLeg) {
      GnssLeg leg;
      leg.from = fixes[i].t - origin;
      leg.to = fixes[k].t - origin;
      leg.speed = 0.5 * (v_i + v_k).norm();
      const Eigen::Vector2d mean = 0.5 * (v_i + v_k).head<2>();
      leg.moving = v_i.head<2>().norm() > moving && v_k.head<2>().norm() > moving && mean.norm() > moving;
      if (leg.moving) {
        leg.course_rate = geo::wrap_angle(std::atan2(v_k.y(), v_k.x()) - std::atan2(v_i.y(), v_i.x())) / dt;
        const Eigen::Vector2d a = (v_k - v_i).head<2>() / dt;
        const Eigen::Vector2d forward = mean.normalized();
        leg.along = forward.dot(a);
        leg.across = forward.x() * a.y() - forward.y() * a.x();
      }
      legs.push_back(leg);
    }
    i = k;
    v_i = v_k;
  }
  return legs;
}

std::optional<RestForce> rest_force(const ImuMeans& means, const std::vector<GnssLeg>& legs) {
  RestForce rest;
  rest.force.setZero();
  // Standstill by GNSS: below 0.1 m/s, or three times the speed of its quietest quarter (noise), at most 0.3 m/s.
  std::vector<double> speeds;
  speeds.reserve(legs.size());
  for (const GnssLeg& leg : legs) speeds.push_back(leg.speed);
  std::sort(speeds.begin(), speeds.end());
  const double floor = speeds.empty() ? 0.0 : speeds[speeds.size() / 20];
  const double limit = std::clamp(3.0 * floor, 0.1, 0.3);
  for (const GnssLeg& leg : legs) {
    if (leg.speed > limit) continue;
    const auto mean = means.over(leg.from, leg.to);
    if (!mean) continue;
    rest.force += mean->force * (leg.to - leg.from);
    rest.seconds += leg.to - leg.from;
  }
  if (rest.seconds >= 2.0) {
    rest.force /= rest.seconds;
    rest.seen = true;
    return rest;
  }
  // No standstill: the seconds whose mean rate is smallest about any axis.
  std::vector<std::pair<double, double>> seconds;
  for (double t = 0.0; t + 1.0 <= means.length(); t += 1.0)
    if (const auto mean = means.over(t, t + 1.0)) seconds.emplace_back(mean->rate.norm(), t);
  if (seconds.empty()) return std::nullopt;
  std::sort(seconds.begin(), seconds.end());
  seconds.resize(std::max<std::size_t>(1, seconds.size() / 50));
  rest.force.setZero();
  for (const auto& second : seconds) rest.force += means.over(second.second, second.second + 1.0)->force;
  rest.seconds = static_cast<double>(seconds.size());
  rest.force /= rest.seconds;
  return rest;
}

namespace {

/// Sums for correlation and slope of turn rate y against course rate x.
struct Correlation {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0, sxy = 0.0;
  void add(double x, double y) {
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    syy += y * y;
    sxy += x * y;
  }
  [[nodiscard]] double vx() const { return sxx - sx * sx / n; }
  [[nodiscard]] double vy() const { return syy - sy * sy / n; }
  [[nodiscard]] double cxy() const { return sxy - sx * sy / n; }
  [[nodiscard]] double r() const { return n > 2.0 && vx() > 0.0 && vy() > 0.0 ? cxy() / std::sqrt(vx() * vy()) : 0.0; }
};

Correlation correlate(const ImuMeans& means, const std::vector<GnssLeg>& legs, const Eigen::Vector3d& down, double shift) {
  Correlation c;
  for (const GnssLeg& leg : legs)
    if (const auto mean = means.over(leg.from + shift, leg.to + shift)) c.add(leg.course_rate, mean->rate.dot(down));
  return c;
}

}  // namespace

std::optional<TimeMatch> match_time(const ImuMeans& means, const std::vector<GnssLeg>& legs, const Eigen::Vector3d& down) {
  std::vector<GnssLeg> moving;
  std::copy_if(legs.begin(), legs.end(), std::back_inserter(moving), [](const GnssLeg& leg) { return leg.moving; });
  const auto by_turn = [](const GnssLeg& a, const GnssLeg& b) { return std::abs(a.course_rate) > std::abs(b.course_rate); };
  if (moving.size() > kMaxLegs) {
    std::nth_element(moving.begin(), moving.begin() + kMaxLegs, moving.end(), by_turn);
    moving.resize(kMaxLegs);
  }
  const auto turning =
      std::count_if(moving.begin(), moving.end(), [](const GnssLeg& l) { return std::abs(l.course_rate) > kLeastTurn; });
  if (turning < static_cast<std::ptrdiff_t>(kLeastLegs)) return std::nullopt;

  const auto steps = static_cast<std::size_t>(kMaxShift / kShiftStep);
  const auto shift_of = [&](std::size_t k) { return kShiftStep * (static_cast<double>(k) - static_cast<double>(steps)); };
  std::vector<double> r(2 * steps + 1);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const Correlation c = correlate(means, moving, down, shift_of(i));
    // A shift with few legs inside the recording is not significant.
    r[i] = c.n < 0.5 * static_cast<double>(moving.size()) || c.n < kLeastLegs ? 0.0 : c.r();
  }
  const auto best = std::max_element(r.begin(), r.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto k = static_cast<std::size_t>(best - r.begin());
  TimeMatch match;
  match.shift = shift_of(k);
  if (k > 0 && k + 1 < r.size()) {
    const double curvature = r[k - 1] - 2.0 * r[k] + r[k + 1];  // vertex of the parabola through three points
    if (curvature * r[k] < 0.0) match.shift += std::clamp(0.5 * (r[k - 1] - r[k + 1]) / curvature, -0.5, 0.5) * kShiftStep;
  }
  const Correlation c = correlate(means, moving, down, match.shift);
  match.correlation = c.r();
  match.slope = c.vx() > 0.0 ? c.cxy() / c.vx() : 0.0;
  match.correlation_unshifted = r[steps];
  return match;
}

std::optional<TravelDirection> travel_direction(const ImuMeans& means, const std::vector<GnssLeg>& legs, double shift,
                                                const Eigen::Vector3d& f_rest) {
  // Level axes: z along the plumb line, x as close as possible to body x (y if x is steep).
  const Eigen::Vector3d down = -f_rest.normalized();
  const Eigen::Vector3d axis = std::abs(down.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Vector3d level_x = axis - down.dot(axis) * down;
  level_x.normalize();
  const Eigen::Vector3d level_y = down.cross(level_x);
  double dot = 0.0, cross = 0.0, a2 = 0.0, f2 = 0.0;
  std::size_t n = 0;
  for (const GnssLeg& leg : legs) {
    if (!leg.moving) continue;
    const auto mean = means.over(leg.from + shift, leg.to + shift);
    if (!mean) continue;
    const Eigen::Vector3d force = mean->force - f_rest;
    const double fx = force.dot(level_x);
    const double fy = force.dot(level_y);
    dot += fx * leg.along + fy * leg.across;
    cross += leg.along * fy - leg.across * fx;
    a2 += leg.along * leg.along + leg.across * leg.across;
    f2 += fx * fx + fy * fy;
    ++n;
  }
  if (n < kLeastLegs || a2 <= 0.0 || f2 <= 0.0 || std::sqrt(a2 / static_cast<double>(n)) < 0.1) return std::nullopt;
  const double yaw = std::atan2(cross, dot);
  return TravelDirection{yaw, std::hypot(dot, cross) / std::sqrt(a2 * f2), std::cos(yaw) * level_x + std::sin(yaw) * level_y};
}

}  // namespace coast::io
