#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "coast/carrier/orbits.hpp"

namespace coast::carrier {

namespace {

using Motion = Eigen::Matrix<double, 6, 1>;

/// d/dt of position and velocity in the rotating frame of PZ-90.11, with the oblateness of the Earth and the given acceleration
/// by Sun and Moon.
Motion derivative(const Motion& x, const Eigen::Vector3d& sun_and_moon) {
  constexpr double kMu = 3.986004418e14;
  constexpr double kRadius = 6378136.0;
  constexpr double kJ2 = 1.08262575e-3;
  constexpr double kOmega = 7.2921151467e-5;
  const Eigen::Vector3d r = x.head<3>();
  const Eigen::Vector3d v = x.tail<3>();
  const double r2 = r.squaredNorm();
  const double over_r3 = kMu / (r2 * std::sqrt(r2));
  const double flattening = 1.5 * kJ2 * kRadius * kRadius / r2;
  const double z = 5.0 * r.z() * r.z() / r2;
  Motion d;
  d.head<3>() = v;
  d(3) = -over_r3 * r.x() * (1.0 + flattening * (1.0 - z)) + kOmega * kOmega * r.x() + 2.0 * kOmega * v.y() + sun_and_moon.x();
  d(4) = -over_r3 * r.y() * (1.0 + flattening * (1.0 - z)) + kOmega * kOmega * r.y() - 2.0 * kOmega * v.x() + sun_and_moon.y();
  d(5) = -over_r3 * r.z() * (1.0 + flattening * (3.0 - z)) + sun_and_moon.z();
  return d;
}

Motion step(const Motion& x, double h, const Eigen::Vector3d& a) {
  const Motion k1 = derivative(x, a);
  const Motion k2 = derivative(x + 0.5 * h * k1, a);
  const Motion k3 = derivative(x + 0.5 * h * k2, a);
  const Motion k4 = derivative(x + h * k3, a);
  return x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

}  // namespace

SatelliteState satellite_state(const record::TabulatedEphemeris& p, geo::GpsTime t) {
  const double dt = t - p.t;
  SatelliteState state;
  state.clock_s = p.clock_bias + p.clock_drift * dt;
  state.clock_rate = p.clock_drift;
  if (p.satellite.system == record::SatelliteSystem::kSbas) {
    state.r_e = p.r_e + dt * p.v_e + 0.5 * dt * dt * p.a_e;
    state.v_e = p.v_e + dt * p.a_e;
    return state;
  }
  constexpr double kStep = 60.0;  // s: 1e-4 m over half an hour
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(dt) / kStep)));
  Motion x;
  x << p.r_e, p.v_e;
  for (int i = 0; i < steps; ++i) x = step(x, dt / steps, p.a_e);
  state.r_e = x.head<3>();
  state.v_e = x.tail<3>();
  return state;
}

}  // namespace coast::carrier
