#include "coast/simulate/trajectory.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::simulate {
namespace {

constexpr double kSegment = 0.25;       // s: 16 nodes integrate a step of 1 s and a tone of 3 Hz to rounding
constexpr double kMargin = 1.0;         // s of motion before and after the stated span
constexpr double kLongestMotion = 2e5;  // s

using Jet1 = Jet<1>;
using Jet2 = Jet<2>;

struct PathVelocity {
  Jet2 north, east, up;
};

PathVelocity path_velocity(const SignalJet& speed, const SinCos<2>& psi, const SignalJet& slope) {
  const SinCos<2> gamma = sincos(truncated<2>(slope));
  const Jet2 v = truncated<2>(speed);
  const Jet2 horizontal = v * gamma.cos;
  return {horizontal * psi.cos, horizontal * psi.sin, v * gamma.sin};
}

struct EulerJets {
  Jet2 roll, pitch, yaw;
};

EulerJets attitude(const MotionPlan& plan, double t, const SignalJet& speed, const SignalJet& course, const SignalJet& slope) {
  const Jet2 lateral = truncated<2>(speed) * rate(course) * (plan.rule.bank / geo::kStandardGravity);
  const Jet2 forward = rate(speed) * (plan.rule.lift / geo::kStandardGravity);
  return {truncated<2>(plan.roll.at(t)) + atan(lateral), truncated<2>(plan.pitch.at(t) + slope) + atan(forward),
          truncated<2>(plan.yaw.at(t) + course)};
}

struct RateJets {
  Jet1 x, y, z;
  [[nodiscard]] Eigen::Vector3d value() const { return {x.value(), y.value(), z.value()}; }
  [[nodiscard]] Eigen::Vector3d derivative() const { return {x.derivative(1), y.derivative(1), z.derivative(1)}; }
};

// Body rate relative to the path axes from Euler rates, z-y-x. Groves (2013, 2nd ed.) eq. (2.58).
RateJets euler_rate(const EulerJets& e) {
  const SinCos<1> roll = sincos(truncated<1>(e.roll));
  const SinCos<1> pitch = sincos(truncated<1>(e.pitch));
  const Jet1 droll = rate(e.roll);
  const Jet1 dpitch = rate(e.pitch);
  const Jet1 dyaw = rate(e.yaw);
  const Jet1 horizontal = dyaw * pitch.cos;
  return {droll - dyaw * pitch.sin, dpitch * roll.cos + horizontal * roll.sin, horizontal * roll.cos - dpitch * roll.sin};
}

// Position of the path axes: stereographic coordinates x = n / 2R, y = e / 2R; C_p_p0 has the Gibbs vector (y, -x, 0).
struct SphereFrame {
  Jet2 north, east, down;  // position in the axes of the origin, m
  Eigen::Matrix3d C_p_p0;
  RateJets omega_ep_p;
};

SphereFrame sphere_frame(const Jet2& n, const Jet2& e, const Jet2& h, double radius) {
  const Jet2 x = n * (0.5 / radius);
  const Jet2 y = e * (0.5 / radius);
  const Jet2 scale = Jet2(2.0) / (1.0 + (x * x + y * y));
  const Jet2 r = h + radius;
  SphereFrame f;
  f.north = r * x * scale;
  f.east = r * y * scale;
  f.down = r * (x * x + y * y) * scale - h;  // not R - r cos: no cancellation

  const double x0 = x.value();
  const double y0 = y.value();
  const double s = scale.value();
  f.C_p_p0 << 1.0 - s * x0 * x0, -s * x0 * y0, -s * x0,  //
      -s * x0 * y0, 1.0 - s * y0 * y0, -s * y0,          //
      s * x0, s * y0, s - 1.0;
  // omega = 2 (g' - g x g') / (1 + |g|^2) in the rotating axes, g the Gibbs vector
  const Jet1 k = truncated<1>(scale);
  const Jet1 xl = truncated<1>(x);
  const Jet1 yl = truncated<1>(y);
  f.omega_ep_p = {k * rate(y), -(k * rate(x)), k * (yl * rate(x) - xl * rate(y))};
  return f;
}

// Chebyshev coefficients of the integral over [-1, 1] scaled by `half`, from values at the Chebyshev points, zero at -1.
template <std::size_t Nodes>
void integrate_chebyshev(const double (&values)[Nodes], double half, double (&integral)[Nodes + 1]) {
  static const std::array<std::array<double, Nodes>, Nodes> kCosine = [] {
    std::array<std::array<double, Nodes>, Nodes> table{};
    for (std::size_t k = 0; k < Nodes; ++k)
      for (std::size_t j = 0; j < Nodes; ++j)
        table[k][j] = std::cos(geo::kPi * static_cast<double>(k) * (static_cast<double>(j) + 0.5) / static_cast<double>(Nodes));
    return table;
  }();
  double a[Nodes + 2] = {};
  for (std::size_t k = 0; k < Nodes; ++k) {
    for (std::size_t j = 0; j < Nodes; ++j) a[k] += values[j] * kCosine[k][j];
    a[k] *= 2.0 / static_cast<double>(Nodes);
  }
  integral[0] = 0.0;
  double at_start = 0.0;
  for (std::size_t k = 1; k <= Nodes; ++k) {
    integral[k] = half * (a[k - 1] - a[k + 1]) / (2.0 * static_cast<double>(k));
    at_start += (k % 2 == 0) ? integral[k] : -integral[k];
  }
  integral[0] = -at_start;
}

}  // namespace

Kinematics at_point(const Kinematics& body, const Eigen::Vector3d& l_b) {
  Kinematics p = body;
  const Eigen::Vector3d turn = body.omega_eb_b.cross(l_b);
  p.r_eb_e += body.C_b_e * l_b;
  p.v_eb_e += body.C_b_e * turn;
  p.a_eb_e += body.C_b_e * (body.alpha_eb_b.cross(l_b) + body.omega_eb_b.cross(turn));
  return p;
}

Eigen::Vector3d omega_ib_b(const Kinematics& body) {
  return body.omega_eb_b + geo::kEarthRate * body.C_b_e.row(2).transpose();
}

Eigen::Vector3d f_ib_b(const Kinematics& body) {
  const Eigen::Vector3d& v = body.v_eb_e;
  const Eigen::Vector3d coriolis = 2.0 * geo::kEarthRate * Eigen::Vector3d(-v.y(), v.x(), 0.0);
  return body.C_b_e.transpose() * (body.a_eb_e + coriolis - geo::gravity_e(body.r_eb_e));
}

AnalyticTrajectory::AnalyticTrajectory(MotionPlan plan) : plan_(std::move(plan)) {
  if (!(plan_.duration > 0.0) || plan_.duration > kLongestMotion)
    throw std::invalid_argument(
        fmt::format("MotionPlan::duration is {} s, expected above 0 and at most {} s", plan_.duration, kLongestMotion));
  const geo::Radii radii = geo::radii_of_curvature(plan_.origin.latitude);
  radius_ = std::sqrt(radii.meridian * radii.prime_vertical) + plan_.origin.height;
  C_p0_e_ = geo::C_n_e(plan_.origin);
  origin_e_ = geo::ecef_from_geodetic(plan_.origin);
  integrate_path();
}

void AnalyticTrajectory::integrate_path() {
  const auto count = static_cast<std::size_t>(std::ceil((plan_.duration + 2.0 * kMargin) / kSegment));
  segments_.resize(count);
  double base[3] = {};
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * kSegment - kMargin;
    double values[3][kNodes];
    for (std::size_t j = 0; j < kNodes; ++j) {
      const double node = std::cos(geo::kPi * (static_cast<double>(j) + 0.5) / static_cast<double>(kNodes));
      const double t = middle + 0.5 * kSegment * node;
      const PathVelocity v = path_velocity(plan_.speed.at(t), sincos(truncated<2>(plan_.course.at(t))), plan_.slope.at(t));
      values[0][j] = v.north.value();
      values[1][j] = v.east.value();
      values[2][j] = v.up.value();
    }
    for (std::size_t c = 0; c < 3; ++c) {
      double(&series)[kNodes + 1] = segments_[i].integral[c];
      integrate_chebyshev(values[c], 0.5 * kSegment, series);
      series[0] += base[c];
      base[c] = 0.0;
      for (double coefficient : series) base[c] += coefficient;  // value at the segment's end: all T_k(1) = 1
    }
  }
}

std::array<double, 3> AnalyticTrajectory::path_position(double t) const {
  if (!(t >= -kMargin) || t > plan_.duration + kMargin)
    throw std::invalid_argument(fmt::format("time {} s is outside the motion, 0 to {} s", t, plan_.duration));
  const double position = (t + kMargin) / kSegment;
  const auto index = std::min(segments_.size() - 1, static_cast<std::size_t>(position));
  const double x = 2.0 * (position - static_cast<double>(index)) - 1.0;
  std::array<double, 3> value{};
  for (std::size_t c = 0; c < 3; ++c) {  // Clenshaw
    double b1 = 0.0;
    double b2 = 0.0;
    for (std::size_t k = kNodes; k >= 1; --k) {
      const double b0 = segments_[index].integral[c][k] + 2.0 * x * b1 - b2;
      b2 = b1;
      b1 = b0;
    }
    value[c] = segments_[index].integral[c][0] + x * b1 - b2;
  }
  return value;
}

Kinematics AnalyticTrajectory::at(double t) const {
  const std::array<double, 3> path = path_position(t);  // first: it rejects times outside of the motion
  const SignalJet speed = plan_.speed.at(t);
  const SignalJet course = plan_.course.at(t);
  const SignalJet slope = plan_.slope.at(t);
  const SinCos<2> psi = sincos(truncated<2>(course));
  const PathVelocity v = path_velocity(speed, psi, slope);
  const Jet2 ahead = truncated<2>(plan_.ahead.at(t));
  const Jet2 right = truncated<2>(plan_.right.at(t));
  const Jet2 n = truncated<2>(integral(path[0], v.north)) + ahead * psi.cos - right * psi.sin;
  const Jet2 e = truncated<2>(integral(path[1], v.east)) + ahead * psi.sin + right * psi.cos;
  const Jet2 h = truncated<2>(integral(path[2], v.up)) - truncated<2>(plan_.down.at(t));
  const SphereFrame frame = sphere_frame(n, e, h, radius_);
  const EulerJets euler = attitude(plan_, t, speed, course, slope);

  Kinematics k;
  k.t = t;
  k.r_eb_e = origin_e_ + C_p0_e_ * Eigen::Vector3d(frame.north.value(), frame.east.value(), frame.down.value());
  k.v_eb_e = C_p0_e_ * Eigen::Vector3d(frame.north.derivative(1), frame.east.derivative(1), frame.down.derivative(1));
  k.a_eb_e = C_p0_e_ * Eigen::Vector3d(frame.north.derivative(2), frame.east.derivative(2), frame.down.derivative(2));
  const Eigen::Matrix3d C_b_p = geo::dcm_from_euler({euler.roll.value(), euler.pitch.value(), euler.yaw.value()});
  k.C_b_e = C_p0_e_ * frame.C_p_p0 * C_b_p;

  const RateJets omega_pb_b = euler_rate(euler);
  const Eigen::Vector3d omega_ep_b = C_b_p.transpose() * frame.omega_ep_p.value();
  k.omega_eb_b = omega_pb_b.value() + omega_ep_b;
  k.alpha_eb_b =
      omega_pb_b.derivative() + C_b_p.transpose() * frame.omega_ep_p.derivative() - omega_pb_b.value().cross(omega_ep_b);
  return k;
}

record::NavState AnalyticTrajectory::nav_state(geo::GpsTime start, double t) const {
  const Kinematics k = at(t);
  return {start + t, k.r_eb_e, k.v_eb_e, Eigen::Quaterniond(k.C_b_e)};
}

}  // namespace coast::simulate
