#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "coast/carrier/orbits.hpp"

namespace coast::carrier {

namespace {

using record::SatelliteSystem;

/// Constants as in each system's interface document; the ephemerides were fitted with these.
struct Earth {
  double mu;     ///< m^3/s^2
  double omega;  ///< rad/s
};
Earth earth_of(SatelliteSystem system) {
  switch (system) {
    case SatelliteSystem::kGalileo:
      return {3.986004418e14, 7.2921151467e-5};
    case SatelliteSystem::kBeidou:
      return {3.986004418e14, 7.292115e-5};
    default:
      return {3.9860050e14, 7.2921151467e-5};
  }
}

/// E - e sin E = M, by Newton's method.
double eccentric_anomaly(double M, double e) {
  double E = M;
  constexpr int kIterations = 20;
  for (int i = 0; i < kIterations; ++i) {
    const double step = (E - e * std::sin(E) - M) / (1.0 - e * std::cos(E));
    E -= step;
    if (std::abs(step) < 1e-14) break;
  }
  return E;
}

bool is_geostationary(record::Satellite satellite) {
  constexpr int kLastOfFirst = 5, kFirstOfNew = 59;
  return satellite.system == SatelliteSystem::kBeidou && (satellite.number <= kLastOfFirst || satellite.number >= kFirstOfNew);
}

}  // namespace

SatelliteState satellite_state(const record::KeplerEphemeris& p, geo::GpsTime t) {
  const Earth earth = earth_of(p.satellite.system);
  const double tk = t - p.toe;
  const double a = p.sqrt_a * p.sqrt_a;
  const double n = std::sqrt(earth.mu / (a * a * a)) + p.delta_n;
  const double e = p.eccentricity;
  const double E = eccentric_anomaly(p.mean_anomaly + n * tk, e);
  const double E_rate = n / (1.0 - e * std::cos(E));

  // Argument of latitude, radius and inclination with their harmonic corrections.
  const double root = std::sqrt(1.0 - e * e);
  const double phi = std::atan2(root * std::sin(E), std::cos(E) - e) + p.perigee;
  const double phi_rate = root * E_rate / (1.0 - e * std::cos(E));
  const double s2 = std::sin(2.0 * phi), c2 = std::cos(2.0 * phi);
  const double u = phi + p.cus * s2 + p.cuc * c2;
  const double u_rate = phi_rate * (1.0 + 2.0 * (p.cus * c2 - p.cuc * s2));
  const double r = a * (1.0 - e * std::cos(E)) + p.crs * s2 + p.crc * c2;
  const double r_rate = a * e * std::sin(E) * E_rate + 2.0 * phi_rate * (p.crs * c2 - p.crc * s2);
  const double i = p.inclination + p.inclination_rate * tk + p.cis * s2 + p.cic * c2;
  const double i_rate = p.inclination_rate + 2.0 * phi_rate * (p.cis * c2 - p.cic * s2);
  const Eigen::Vector3d in_plane(r * std::cos(u), r * std::sin(u), 0.0);
  const Eigen::Vector3d in_plane_rate(r_rate * std::cos(u) - r * u_rate * std::sin(u),
                                      r_rate * std::sin(u) + r * u_rate * std::cos(u), 0.0);

  // The node is given for the beginning of the week; for BeiDou of its own week, 14 s later.
  constexpr double kGpsMinusBeidou = 14.0;
  const double toe = p.satellite.system == SatelliteSystem::kBeidou ? (p.toe - kGpsMinusBeidou).sow() : p.toe.sow();
  const bool geostationary = is_geostationary(p.satellite);
  const double node_rate = p.node_rate - (geostationary ? 0.0 : earth.omega);
  const double node = p.node + node_rate * tk - earth.omega * toe;
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Matrix3d turn = AngleAxisd(node, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d tilt = AngleAxisd(i, Vector3d::UnitX()).toRotationMatrix();
  SatelliteState state;
  const Vector3d tilted = tilt * in_plane;
  state.r_e = turn * tilted;
  state.v_e =
      turn * (tilt * in_plane_rate + i_rate * Vector3d::UnitX().cross(tilted) + node_rate * Vector3d::UnitZ().cross(tilted));
  if (geostationary) {
    // Its elements refer to a plane tilted by 5 degrees, in a frame that does not rotate.
    constexpr double kTilt = 5.0 * std::numbers::pi / 180.0;
    const Eigen::Matrix3d C = AngleAxisd(-earth.omega * tk, Vector3d::UnitZ()).toRotationMatrix() *
                              AngleAxisd(kTilt, Vector3d::UnitX()).toRotationMatrix();
    state.r_e = C * state.r_e;
    state.v_e = C * state.v_e - earth.omega * Vector3d::UnitZ().cross(state.r_e);
  }

  // Clock, with the periodic part of relativity: -2 sqrt(mu a) e sin(E)/c^2.
  constexpr double kLight = 299792458.0;
  const double tc = t - p.toc;
  const double relativity = -2.0 * std::sqrt(earth.mu) * p.sqrt_a * e / (kLight * kLight);
  state.clock_s = p.clock[0] + tc * (p.clock[1] + tc * p.clock[2]) + relativity * std::sin(E);
  state.clock_rate = p.clock[1] + 2.0 * tc * p.clock[2] + relativity * std::cos(E) * E_rate;
  return state;
}

}  // namespace coast::carrier
