#include "coast/carrier/solid_tides.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numeric>

#include "coast/geo/units.hpp"

namespace coast::carrier {

namespace {

using geo::kDegree;
using std::cos;
using std::sin;

constexpr double kArcSecond = kDegree / 3600.0;

/// Days since 2000-01-01 12:00 in the calendar of GPS time.
double days_since_2000(geo::GpsTime t) {
  return (t - geo::GpsTime::from_calendar({2000, 1, 1, 12, 0, 0.0})) / 86400.0;
}

/// Julian centuries of terrestrial time since J2000.
double centuries(geo::GpsTime t) {
  constexpr double kTerrestrialAhead = 51.184;  // s, of GPS
  return (days_since_2000(t) + kTerrestrialAhead / 86400.0) / 36525.0;
}

/// Greenwich mean sidereal time, rad: Earth rotation angle and precession in right ascension, IERS Conventions (2010) (5.15)
/// and (5.32) to first order, with UT1 = UTC.
double sidereal_time(geo::GpsTime t) {
  const double days = days_since_2000(t) - geo::leap_seconds(t) / 86400.0;
  // A full rotation per day is subtracted before the multiplication, which would lose digits.
  const double turns = 0.7790572732640 + 0.00273781191135448 * days + std::fmod(days, 1.0);
  return std::fmod(turns, 1.0) * 2.0 * geo::kPi + 4612.156534 * kArcSecond * centuries(t);
}

/// From ecliptic longitude and latitude of date to ECEF.
Eigen::Vector3d from_ecliptic(double longitude, double latitude, double distance, geo::GpsTime t) {
  const double obliquity = (23.43929111 - 0.0130042 * centuries(t)) * kDegree;
  const Eigen::Vector3d ecliptic(cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude));
  return distance * (Eigen::AngleAxisd(-sidereal_time(t), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(obliquity, Eigen::Vector3d::UnitX()) * ecliptic);
}

struct Point {
  Eigen::Vector3d up, north, east;  ///< geocentric, ECEF
  double sine = 0.0, cosine = 0.0;  ///< of the geocentric latitude
  double longitude = 0.0;
};

Point point_at(const Eigen::Vector3d& r_e) {
  Point p;
  p.up = r_e.normalized();
  p.sine = p.up.z();
  p.cosine = std::hypot(p.up.x(), p.up.y());
  p.longitude = std::atan2(p.up.y(), p.up.x());
  p.east = Eigen::Vector3d(-sin(p.longitude), cos(p.longitude), 0.0);
  p.north = p.up.cross(p.east);
  return p;
}

/// The effect of a body at a point.
struct Raised {
  double amplitude = 0.0;  ///< GM_j Re^4 / (GM R_j^3) of degree 2, m
  double degree3 = 0.0;    ///< Re / R_j, from degree 2 to 3
  Eigen::Vector3d direction;
  double sine = 0.0, cosine = 0.0;  ///< of the body's declination
  double angle = 0.0;               ///< longitude of the point less that of the body, rad
};

Raised raised_by(const Eigen::Vector3d& body_e, double mass, const Point& p) {
  constexpr double kRadius = 6378136.6;  // m
  const double ratio = kRadius / body_e.norm();
  const Eigen::Vector3d direction = body_e.normalized();
  return {mass * kRadius * ratio * ratio * ratio,
          ratio,
          direction,
          direction.z(),
          std::hypot(direction.x(), direction.y()),
          p.longitude - std::atan2(direction.y(), direction.x())};
}

/// IERS Conventions (2010) (7.5), (7.6).
Eigen::Vector3d in_phase(const Raised& body, const Point& p) {
  const double p2 = 0.5 * (3.0 * p.sine * p.sine - 1.0);
  const double h2 = 0.6078 - 0.0006 * p2, l2 = 0.0847 + 0.0002 * p2;
  constexpr double kH3 = 0.292, kL3 = 0.015;
  const double c = body.direction.dot(p.up);
  const Eigen::Vector3d towards = body.direction - c * p.up;
  const Eigen::Vector3d degree2 = h2 * (1.5 * c * c - 0.5) * p.up + 3.0 * l2 * c * towards;
  const Eigen::Vector3d degree3 = kH3 * (2.5 * c * c - 1.5) * c * p.up + kL3 * (7.5 * c * c - 1.5) * towards;
  return body.amplitude * (degree2 + body.degree3 * degree3);
}

/// Out-of-phase part due to the anelastic mantle: IERS Conventions (2010) (7.10), (7.11).
Eigen::Vector3d out_of_phase(const Raised& body, const Point& p) {
  constexpr double kH1 = -0.0025, kL1 = -0.0007;  // diurnal
  constexpr double kH2 = -0.0022, kL2 = -0.0007;  // semidiurnal
  const double sin_2lat = 2.0 * p.sine * p.cosine, cos_2lat = p.cosine * p.cosine - p.sine * p.sine;
  const double s1 = sin(body.angle), c1 = cos(body.angle), s2 = sin(2.0 * body.angle), c2 = cos(2.0 * body.angle);
  const double sin_2dec = 2.0 * body.sine * body.cosine, cos2_dec = body.cosine * body.cosine;
  const Eigen::Vector3d diurnal =
      -0.75 * kH1 * sin_2dec * sin_2lat * s1 * p.up - 1.5 * kL1 * sin_2dec * (cos_2lat * s1 * p.north + p.sine * c1 * p.east);
  const Eigen::Vector3d semidiurnal = -0.75 * kH2 * cos2_dec * p.cosine * p.cosine * s2 * p.up +
                                      0.75 * kL2 * cos2_dec * (sin_2lat * s2 * p.north - 2.0 * p.cosine * c2 * p.east);
  return body.amplitude * (diurnal + semidiurnal);
}

/// The latitude dependence that is not a gradient, l(1): IERS Conventions (2010) (7.8), (7.9).
Eigen::Vector3d toroidal(const Raised& body, const Point& p) {
  constexpr double kDiurnal = 0.0012, kSemidiurnal = 0.0024;
  const double p21 = 3.0 * body.sine * body.cosine, p22 = 3.0 * body.cosine * body.cosine;
  const double cos_2lat = p.cosine * p.cosine - p.sine * p.sine;
  const Eigen::Vector3d diurnal =
      -kDiurnal * p.sine * p21 * (p.sine * cos(body.angle) * p.north - cos_2lat * sin(body.angle) * p.east);
  const Eigen::Vector3d semidiurnal = -0.5 * kSemidiurnal * p.sine * p.cosine * p22 *
                                      (cos(2.0 * body.angle) * p.north + p.sine * sin(2.0 * body.angle) * p.east);
  return body.amplitude * (diurnal + semidiurnal);
}

/// A tide with Love and Shida numbers different from the nominal ones.
struct Line {
  std::array<double, 5> multipliers;     ///< of s, h, p, N', ps; of tau it is 1 for the diurnal, 0 for the zonal tides
  double radial_in, radial_out;          ///< mm
  double tangential_in, tangential_out;  ///< mm
};
// IERS Conventions (2010) tables 7.3a and 7.3b, the lines of 0.05 mm and more.
constexpr std::array<Line, 11> kDiurnal{{{{-2, 0, 1, 0, 0}, -0.08, 0.00, -0.01, 0.01},
                                         {{-1, 0, 0, -1, 0}, -0.10, 0.00, 0.00, 0.00},
                                         {{-1, 0, 0, 0, 0}, -0.51, 0.00, -0.02, 0.03},  // O1
                                         {{0, 0, 1, 0, 0}, 0.06, 0.00, 0.00, 0.00},
                                         {{1, -3, 0, 0, 1}, -0.06, 0.00, 0.00, 0.00},
                                         {{1, -2, 0, 0, 0}, -1.23, -0.07, 0.06, 0.01},  // P1
                                         {{1, 0, 0, -1, 0}, -0.22, 0.01, 0.01, 0.00},
                                         {{1, 0, 0, 0, 0}, 12.00, -0.78, -0.67, -0.03},  // K1
                                         {{1, 0, 0, 1, 0}, 1.73, -0.12, -0.10, 0.00},
                                         {{1, 1, 0, 0, -1}, -0.50, -0.01, 0.03, 0.00},
                                         {{1, 2, 0, 0, 0}, -0.11, 0.01, 0.01, 0.00}}};
constexpr std::array<Line, 5> kZonal{{{{0, 0, 0, 1, 0}, 0.47, 0.16, 0.23, 0.07},
                                      {{0, 2, 0, 0, 0}, -0.20, -0.11, -0.12, -0.05},
                                      {{1, 0, -1, 0, 0}, -0.11, -0.09, -0.08, -0.04},
                                      {{2, 0, 0, 0, 0}, -0.13, -0.15, -0.11, -0.07},
                                      {{2, 0, 0, 1, 0}, -0.05, -0.06, -0.05, -0.03}}};

/// Corrections to (7.5) at single frequencies by the resonance of the free core nutation and the anelastic mantle, m:
/// IERS Conventions (2010) (7.12), (7.13).
Eigen::Vector3d by_frequency(const Point& p, geo::GpsTime t) {
  const double T = centuries(t);
  // Longitudes of Moon, Sun, perigee, minus that of the node, perihelion, of date.
  const std::array<double, 5> longitudes{218.3165 + 481267.8813 * T, 280.4665 + 36000.7698 * T, 83.3532 + 4069.0137 * T,
                                         234.9555 + 1934.1363 * T, 282.9373 + 1.7195 * T};
  const auto argument = [&](const Line& line) {
    return kDegree * std::inner_product(line.multipliers.begin(), line.multipliers.end(), longitudes.begin(), 0.0);
  };
  const double tau = sidereal_time(t) + geo::kPi - longitudes[0] * kDegree;
  const double sin_2lat = 2.0 * p.sine * p.cosine, cos_2lat = p.cosine * p.cosine - p.sine * p.sine;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Line& line : kDiurnal) {
    const double s = sin(tau + argument(line) + p.longitude), c = cos(tau + argument(line) + p.longitude);
    sum += (line.radial_in * s + line.radial_out * c) * sin_2lat * p.up +
           (line.tangential_in * s + line.tangential_out * c) * cos_2lat * p.north +
           (line.tangential_in * c - line.tangential_out * s) * p.sine * p.east;
  }
  for (const Line& line : kZonal) {
    const double s = sin(argument(line)), c = cos(argument(line));
    sum += (line.radial_in * c + line.radial_out * s) * (1.5 * p.sine * p.sine - 0.5) * p.up +
           (line.tangential_in * c + line.tangential_out * s) * sin_2lat * p.north;
  }
  return 1e-3 * sum;
}

}  // namespace

Eigen::Vector3d sun_e(geo::GpsTime t) {
  const double T = centuries(t);
  const double anomaly = (357.52911 + 35999.05029 * T) * kDegree;
  const double centre = (1.914602 - 0.004817 * T) * sin(anomaly) + (0.019993 - 0.000101 * T) * sin(2.0 * anomaly) +
                        0.000289 * sin(3.0 * anomaly);  // degrees
  const double longitude = (280.46646 + 36000.76983 * T + centre) * kDegree;
  const double eccentricity = 0.016708634 - 0.000042037 * T;
  constexpr double kAstronomicalUnit = 149597870700.0;  // m
  const double distance =
      1.000001018 * (1.0 - eccentricity * eccentricity) / (1.0 + eccentricity * cos(anomaly + centre * kDegree));
  return from_ecliptic(longitude, 0.0, distance * kAstronomicalUnit, t);
}

Eigen::Vector3d moon_e(geo::GpsTime t) {
  const double T = centuries(t);
  // Mean longitude of date, while the book's is of J2000; anomalies of Moon and Sun, distance from the node, elongation.
  const double mean = (218.31617 + 481267.88088 * T) * kDegree;
  const double l = (134.96292 + 477198.86753 * T) * kDegree, ls = (357.52543 + 35999.04944 * T) * kDegree;
  const double f = (93.27283 + 483202.01873 * T) * kDegree, d = (297.85027 + 445267.11135 * T) * kDegree;
  const double d2 = 2.0 * d;
  const double periodic = 22640.0 * sin(l) + 769.0 * sin(2.0 * l) - 4586.0 * sin(l - d2) + 2370.0 * sin(d2) - 668.0 * sin(ls) -
                          412.0 * sin(2.0 * f) - 212.0 * sin(2.0 * l - d2) - 206.0 * sin(l + ls - d2) + 192.0 * sin(l + d2) -
                          165.0 * sin(ls - d2) + 148.0 * sin(l - ls) - 125.0 * sin(d) - 110.0 * sin(l + ls) -
                          55.0 * sin(2.0 * f - d2);  // arc seconds, like the next
  const double from_node = f + (periodic + 412.0 * sin(2.0 * f) + 541.0 * sin(ls)) * kArcSecond;
  const double latitude = 18520.0 * sin(from_node) - 526.0 * sin(f - d2) + 44.0 * sin(l + f - d2) - 31.0 * sin(f - l - d2) -
                          25.0 * sin(f - 2.0 * l) - 23.0 * sin(ls + f - d2) + 21.0 * sin(f - l) + 11.0 * sin(f - ls - d2);
  const double distance = 385000.0 - 20905.0 * cos(l) - 3699.0 * cos(d2 - l) - 2956.0 * cos(d2) - 570.0 * cos(2.0 * l) +
                          246.0 * cos(2.0 * l - d2) - 205.0 * cos(ls - d2) - 171.0 * cos(l + d2) -
                          152.0 * cos(l + ls - d2);  // km
  return from_ecliptic(mean + periodic * kArcSecond, latitude * kArcSecond, distance * 1e3, t);
}

Eigen::Vector3d solid_tide(const Eigen::Vector3d& r_e, geo::GpsTime t) {
  return solid_tide(r_e, t, sun_e(t), moon_e(t));
}

Eigen::Vector3d solid_tide(const Eigen::Vector3d& r_e, geo::GpsTime t, const Eigen::Vector3d& r_sun_e,
                           const Eigen::Vector3d& r_moon_e) {
  constexpr double kMoon = 0.0123000371, kSun = 332946.0487;  // masses over the Earth's, IERS Conventions (2010) table 1.1
  const Point p = point_at(r_e);
  Eigen::Vector3d displacement = by_frequency(p, t);
  for (const Raised& body : {raised_by(r_moon_e, kMoon, p), raised_by(r_sun_e, kSun, p)})
    displacement += in_phase(body, p) + out_of_phase(body, p) + toroidal(body, p);
  return displacement;
}

}  // namespace coast::carrier
