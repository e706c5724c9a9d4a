#include "coast/carrier/wind_up.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <vector>

#include "coast/carrier/orbits.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"

namespace coast::carrier {
namespace {

using Eigen::Vector3d;

constexpr double kCycle = 2.0 * std::numbers::pi;
const Vector3d kSunAt = 1.496e11 * Vector3d(-0.6, 0.7, -0.3).normalized();

/// A satellite of GPS at this azimuth and elevation, rad.
Vector3d satellite_at(const geo::Geodetic& at, double azimuth, double elevation) {
  const Vector3d receiver = geo::ecef_from_geodetic(at);
  const Vector3d ned(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), -std::sin(elevation));
  const Vector3d way = geo::C_n_e(at) * ned;
  constexpr double kOrbit = 26560e3;
  const double b = receiver.dot(way);
  return receiver + (std::sqrt(b * b + kOrbit * kOrbit - receiver.squaredNorm()) - b) * way;
}

/// The level antenna at `at`, turned clockwise by yaw.
Eigen::Matrix3d level(const geo::Geodetic& at, double yaw) {
  return geo::C_n_e(at) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
}

double upright(const Vector3d& r_satellite_e, const Vector3d& r_sun_e, const geo::Geodetic& at, double previous) {
  return wind_up(r_satellite_e, r_sun_e, geo::ecef_from_geodetic(at), level(at, 0.0), previous);
}

/// Distance of a - b from the nearest whole number.
double apart(double a, double b) {
  return std::abs(a - b - std::round(a - b));
}

const geo::Geodetic kHome{46.5 * geo::kDegree, 6.6 * geo::kDegree, 400.0};

TEST(YawSteering, AxesAreThoseOfTheConvention) {
  // Satellite on x, Sun towards +y: z is -x, y is z x Sun = -z of ECEF, x to the Sun.
  const Eigen::Matrix3d axes = yaw_steering_axes({26560e3, 0.0, 0.0}, {0.5e11, 1.4e11, 0.0});
  EXPECT_TRUE(axes.col(0).isApprox(Vector3d(0.0, 1.0, 0.0), 1e-15));
  EXPECT_TRUE(axes.col(1).isApprox(Vector3d(0.0, 0.0, -1.0), 1e-15));
  EXPECT_TRUE(axes.col(2).isApprox(Vector3d(-1.0, 0.0, 0.0), 1e-15));
  const Vector3d satellite = satellite_at(kHome, 1.0, 0.5);
  const Eigen::Matrix3d general = yaw_steering_axes(satellite, kSunAt);
  EXPECT_TRUE((general.transpose() * general).isApprox(Eigen::Matrix3d::Identity(), 1e-14));
  EXPECT_NEAR(general.determinant(), 1.0, 1e-14);
  EXPECT_NEAR(general.col(1).dot(kSunAt - satellite) / kSunAt.norm(), 0.0, 1e-14);
  EXPECT_GT(general.col(0).dot(kSunAt - satellite), 0.0);
  // Yaw is not defined here; no NaN leaves.
  EXPECT_EQ(wind_up({26560e3, 0.0, 0.0}, {1.5e11, 0.0, 0.0}, {6378e3, 0.0, 0.0}, level({}, 0.0), 3.0), 3.0);
}

// The field of a right-handed wave from above turns clockwise seen from above, from north to east. An antenna that turns with
// it receives a lower frequency, as from a satellite that moves away: a phase that grows with the distance grows by a cycle a
// turn. Of a level antenna this is exact at every elevation: the effective dipole is (1 + sin(elevation)) long, at azimuth less
// yaw from the vertical plane of the satellite.
TEST(WindUp, TurnOfTheReceiverIsACycle) {
  for (const double elevation : {10.0, 30.0, 60.0, 89.99, 90.0}) {
    const Vector3d satellite = satellite_at(kHome, 2.0, elevation * geo::kDegree), receiver = geo::ecef_from_geodetic(kHome);
    const double start = wind_up(satellite, kSunAt, receiver, level(kHome, 0.0), 0.0);
    double wound = start;
    for (int step = 1; step <= 72; ++step) {
      wound = wind_up(satellite, kSunAt, receiver, level(kHome, 5.0 * geo::kDegree * step), wound);
      EXPECT_NEAR(wound - start, step / 72.0, 1e-12) << elevation;
    }
    for (int step = 71; step >= -72; --step)
      wound = wind_up(satellite, kSunAt, receiver, level(kHome, 5.0 * geo::kDegree * step), wound);
    EXPECT_NEAR(wound - start, -1.0, 1e-12);
  }
}

// An antenna tilted by 25 degrees on its turntable does not turn evenly, but by whole cycles, as long as the satellite does not
// pass behind it.
TEST(WindUp, TurnOfATiltedReceiverIsACycleToo) {
  const Vector3d receiver = geo::ecef_from_geodetic(kHome);
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(25.0 * geo::kDegree, Vector3d(0.6, 0.8, 0.0)).toRotationMatrix();
  for (const double azimuth : {0.3, 2.3, 4.3}) {
    const Vector3d satellite = satellite_at(kHome, azimuth, 35.0 * geo::kDegree);
    const double start = wind_up(satellite, kSunAt, receiver, level(kHome, 0.0) * tilt, 0.0);
    double wound = start, uneven = 0.0;
    for (int step = 1; step <= 72; ++step) {
      wound = wind_up(satellite, kSunAt, receiver, level(kHome, 5.0 * geo::kDegree * step) * tilt, wound);
      uneven = std::max(uneven, std::abs(wound - start - step / 72.0));
    }
    EXPECT_NEAR(wound - start, 1.0, 1e-12);
    EXPECT_GT(uneven, 0.01);
    EXPECT_LT(uneven, 0.25);
  }
}

// Meridians meet at a pole: two level antennas that point north and a satellite above the pole differ by their longitudes,
// whatever their latitudes, and turning the satellite counterclockwise, seen from above, winds up. All without remainder,
// because an effective dipole's angle is that of the plane through the antenna's axis.
TEST(WindUp, SatelliteAboveThePole) {
  const Vector3d satellite(0.0, 0.0, 26560e3);
  const auto receiver = [](double latitude, double longitude) {
    return geo::Geodetic{latitude * geo::kDegree, longitude * geo::kDegree, 0.0};
  };
  const double one = upright(satellite, kSunAt, receiver(80.0, 10.0), 0.0);
  // North turns counterclockwise on the way east, as seen from above: it unwinds.
  EXPECT_NEAR(upright(satellite, kSunAt, receiver(40.0, 55.0), one) - one, -45.0 / 360.0, 1e-12);
  const Vector3d later_sun = Eigen::AngleAxisd(0.2, Vector3d::UnitZ()) * kSunAt;
  EXPECT_NEAR(upright(satellite, later_sun, receiver(80.0, 10.0), one) - one, 0.2 / (kCycle), 1e-12);
}

/// Great circle's azimuth at one point of the sphere towards another (Snyder 1987, eq. (5-4b)).
double bearing(const Vector3d& from, const Vector3d& to) {
  const double lat1 = std::asin(from.normalized().z()), lat2 = std::asin(to.normalized().z());
  const double dlon = std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x());
  return std::atan2(std::cos(lat2) * std::sin(dlon),
                    std::cos(lat1) * std::sin(lat2) - std::sin(lat1) * std::cos(lat2) * std::cos(dlon));
}

// An effective dipole's angle is that of the plane through its antenna's axis. Where both axes point to the geocentre it is one
// plane, and wind-up is spherical trigonometry on positions: half a cycle, and the azimuth of the receiver at the foot of the
// satellite, from the Sun's, less the azimuth of the foot at the receiver.
TEST(WindUp, IsSphericalTrigonometry) {
  for (const double azimuth : {0.4, 1.7, 3.1, 5.0})
    for (const double elevation : {5.0, 45.0, 80.0})
      for (const double longitude : {6.6, 7.0, 25.0, 200.0}) {
        const geo::Geodetic at{-0.7, longitude * geo::kDegree, 100.0};
        const Vector3d receiver = geo::ecef_from_geodetic(at), satellite = satellite_at(at, azimuth, elevation * geo::kDegree);
        Eigen::Matrix3d C_b_e;
        const Vector3d down = -receiver.normalized(), east = Vector3d::UnitZ().cross(receiver).normalized();
        C_b_e << east.cross(down), east, down;
        const double angle = bearing(satellite, receiver) - bearing(satellite, kSunAt) - bearing(receiver, satellite);
        EXPECT_LT(apart(wind_up(satellite, kSunAt, receiver, C_b_e, 0.0), 0.5 + angle / (kCycle)), 1e-12);
      }
}

// So wind-up changes along a baseline of length d by what meridians converge, d tan(latitude) / R at most, and by the excess of
// the triangle with the foot of the satellite, d tan(s / 2) / R, where s is the arc to the foot, 76 degrees or less. Between
// satellites only the second remains. Wu et al. (1993) have 4 cm, a fifth of a cycle, at 4000 km.
TEST(WindUp, IsAlmostTheSameNearby) {
  for (const double kilometres : {10.0, 100.0}) {
    const double arc = kilometres / 6370.0;
    const double convergence = arc * std::tan(kHome.latitude) / (kCycle), excess = arc * 0.79 / (kCycle);
    for (const double azimuth : {0.4, 1.7, 3.1, 5.0})
      for (const double elevation : {5.0, 45.0, 75.0}) {
        const Vector3d satellite = satellite_at(kHome, azimuth, elevation * geo::kDegree);
        const auto change = [&](double dlat, double dlon) {
          const double wound = upright(satellite, kSunAt, kHome, 0.0);
          return upright(satellite, kSunAt, {kHome.latitude + dlat, kHome.longitude + dlon, 0.0}, wound) - wound;
        };
        // Second order in the arc, and the flattening of the Earth, within a twentieth.
        EXPECT_LT(std::abs(change(arc, 0.0)), 1.05 * excess);
        EXPECT_NEAR(change(0.0, arc / std::cos(kHome.latitude)), -convergence, 1.05 * excess);
      }
  }
}

// Dipoles without circular shortcuts: the satellite feeds x' and y' such that the field turns right-handed about z', the
// receiver delays its left dipole by a quarter, which adds up what comes right-handed from above. Where the antennas do not
// face each other a part tan^2(angle / 2) of each is left-handed, which the effective dipoles leave out: the product of both,
// as an angle, is the tolerance.
TEST(WindUp, AgreesWithCrossedDipoles) {
  using Phasor = std::complex<double>;
  constexpr Phasor kQuarter(0.0, -1.0);  // a quarter later, with exp(+i omega t)
  for (const double yaw : {0.0, 1.0, 2.5, 4.0})
    for (const double elevation : {15.0, 40.0, 65.0, 85.0}) {
      const Vector3d receiver = geo::ecef_from_geodetic(kHome),
                     satellite = satellite_at(kHome, 1.2 + yaw, elevation * geo::kDegree);
      const Vector3d k = (receiver - satellite).normalized();
      const Eigen::Matrix3d axes = yaw_steering_axes(satellite, kSunAt), C_b_e = level(kHome, yaw);
      const Eigen::Vector3cd fed = axes.col(0).cast<Phasor>() + kQuarter * axes.col(1).cast<Phasor>();
      const Eigen::Vector3cd field = fed - (k * k.transpose()).cast<Phasor>() * fed;
      const auto induced = [&](const Vector3d& dipole) { return (dipole.transpose().cast<Phasor>() * field).value(); };
      const Phasor voltage = induced(C_b_e.col(0)) + kQuarter * induced(-C_b_e.col(1));
      const double nadir = std::acos(axes.col(2).dot(k)), zenith = (90.0 - elevation) * geo::kDegree;
      const double left_handed = std::pow(std::tan(nadir / 2.0) * std::tan(zenith / 2.0), 2);
      EXPECT_LT(left_handed, 0.02);
      // A phase received later is a longer distance.
      const double expected = -std::arg(voltage) / (kCycle);
      EXPECT_LT(apart(wind_up(satellite, kSunAt, receiver, C_b_e, 0.0), expected), std::asin(left_handed) / (kCycle) + 1e-12)
          << yaw << ' ' << elevation;
    }
}

// The voltage of crossed dipoles in a wave that is circular about the line of sight, whatever the antenna's attitude; against
// that of the same antenna upright, by the shortest way, it is a pure angle. The spread between satellites above 15 degrees is
// what one who does not know the attitude takes for noise.
TEST(WindUpByTilt, AgreesWithCrossedDipolesAndSpreadsOverTheSky) {
  using Phasor = std::complex<double>;
  constexpr Phasor kQuarter(0.0, -1.0);
  const Vector3d up = Vector3d::UnitZ();
  const std::map<double, double> spreads{{15.0, 0.014}, {30.0, 0.029}, {45.0, 0.046}};
  for (const auto& [bank, spread] : spreads) {
    const Eigen::Matrix3d upright =
        (Eigen::AngleAxisd(0.7, up) * Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX())).matrix();
    const Eigen::Matrix3d tilted = upright * Eigen::AngleAxisd(bank * geo::kDegree, Vector3d::UnitX());
    std::vector<double> cycles;
    for (double elevation = 15.0; elevation < 80.0; elevation += 15.0)
      for (double azimuth = 0.0; azimuth < 360.0; azimuth += 30.0) {
        const double el = elevation * geo::kDegree, az = azimuth * geo::kDegree;
        const Vector3d way(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el));
        const Vector3d a = way.unitOrthogonal(), b = -way.cross(a);  // a, b and the direction of travel are right-handed
        const Eigen::Vector3cd field = a.cast<Phasor>() + kQuarter * b.cast<Phasor>();
        const auto voltage = [&](const Eigen::Matrix3d& C) {
          return ((C.col(0).cast<Phasor>() - kQuarter * C.col(1).cast<Phasor>()).transpose() * field).value();
        };
        const double expected = -std::arg(voltage(tilted) / voltage(upright)) / kCycle;
        cycles.push_back(wind_up_by_tilt(way, up, tilted));
        EXPECT_LT(apart(cycles.back(), expected), 1e-14);
      }
    const Eigen::Map<const Eigen::ArrayXd> all(cycles.data(), static_cast<Eigen::Index>(cycles.size()));
    EXPECT_NEAR(std::sqrt((all - all.mean()).square().mean()), spread, 5e-4);
  }
}

}  // namespace
}  // namespace coast::carrier
