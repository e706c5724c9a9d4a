#include "coast/geo/earth.hpp"

#include <fmt/format.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <stdexcept>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::geo {

namespace {

// WGS 84 (NGA.STND.0036, 2014), table 3.1: defining parameters.
constexpr double kSemiMajor = 6378137.0;  // m
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);

}  // namespace

Radii radii_of_curvature(double latitude) {
  const double s = std::sin(latitude);
  const double w2 = 1.0 - kEccentricity2 * s * s;
  const double w = std::sqrt(w2);
  return {kSemiMajor * (1.0 - kEccentricity2) / (w2 * w), kSemiMajor / w};
}

Eigen::Vector3d ecef_from_geodetic(const Geodetic& p) {
  // In radians throughout: GeographicLib's forward needs degrees, with two roundings of the angle.
  const double N = radii_of_curvature(p.latitude).prime_vertical;
  const double c = std::cos(p.latitude);
  return {(N + p.height) * c * std::cos(p.longitude), (N + p.height) * c * std::sin(p.longitude),
          (N * (1.0 - kEccentricity2) + p.height) * std::sin(p.latitude)};
}

Geodetic geodetic_from_ecef(const Eigen::Vector3d& r_e) {
  double latitude = 0.0;
  double longitude = 0.0;
  double height = 0.0;
  GeographicLib::Geocentric::WGS84().Reverse(r_e.x(), r_e.y(), r_e.z(), latitude, longitude, height);
  return {latitude * kDegree, wrap_angle(longitude * kDegree), height};
}

Eigen::Matrix3d C_n_e(const Geodetic& p) {
  const double sl = std::sin(p.latitude), cl = std::cos(p.latitude);
  const double so = std::sin(p.longitude), co = std::cos(p.longitude);
  Eigen::Matrix3d C;
  C << -sl * co, -so, -cl * co,  //
      -sl * so, co, -cl * so,    //
      cl, 0.0, -sl;
  return C;
}

Eigen::Vector3d gravity_e(const Eigen::Vector3d& r_e) {
  Eigen::Vector3d g;
  GeographicLib::NormalGravity::WGS84().U(r_e.x(), r_e.y(), r_e.z(), g.x(), g.y(), g.z());
  return g;
}

const Eigen::Vector3d& LocalGravity::at(const Eigen::Vector3d& r_e) {
  constexpr double kReach = 50.0;  // m; the neglected second order is 3 g (d/r)^2 = 1.8e-9 m/s^2 there
  constexpr double kStep = 10.0;   // m; truncation 1e-17, rounding 2e-16, both in 1/s^2 against 3e-6
  if ((r_e - r0_).squaredNorm() > kReach * kReach) {
    r0_ = r_e;
    g0_ = gravity_e(r_e);
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(j);
      gradient_.col(j) = (gravity_e(r_e + step) - gravity_e(r_e - step)) / (2.0 * kStep);
    }
  }
  g_ = g0_ + gradient_ * (r_e - r0_);
  return g_;
}

LocalFrame::LocalFrame(const Geodetic& origin) : origin_e_(ecef_from_geodetic(origin)), C_n_e_(geo::C_n_e(origin)) {}

Geodetic geodetic_from_utm(int zone, bool northern, double easting, double northing, double height) {
  if (zone < GeographicLib::UTMUPS::MINUTMZONE || zone > GeographicLib::UTMUPS::MAXUTMZONE) {
    throw std::invalid_argument(fmt::format("UTM zone {}, must be 1 to 60", zone));
  }
  double latitude = 0.0;
  double longitude = 0.0;
  try {
    GeographicLib::UTMUPS::Reverse(zone, northern, easting, northing, latitude, longitude);
  } catch (const GeographicLib::GeographicErr& e) {
    throw std::invalid_argument(fmt::format("UTM coordinates {} m, {} m: {}", easting, northing, e.what()));
  }
  return {latitude * kDegree, wrap_angle(longitude * kDegree), height};
}

}  // namespace coast::geo
