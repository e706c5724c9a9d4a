#include "coast/geo/earth.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "coast/geo/units.hpp"
#include "support/support.hpp"

namespace coast::geo {
namespace {

// NGA.STND.0036 (2014), WGS 84: defining and derived constants, as printed.
constexpr double kA = 6378137.0;
constexpr double kB = 6356752.3142;
constexpr double kE2 = 6.694379990141e-3;
constexpr double kGM = 3.986004418e14;
constexpr double kGravityEquator = 9.7803253359;
constexpr double kGravityPole = 9.8321849379;
constexpr double kSomigliana = 0.00193185265241;

Geodetic degrees(double latitude, double longitude, double height) {
  return {latitude * kDegree, longitude * kDegree, height};
}

std::vector<Geodetic> places() {
  std::vector<Geodetic> list = {degrees(0, 0, 0),
                                degrees(90, 0, 100),
                                degrees(90, 30, 0),
                                degrees(-90, -120, 3000),
                                degrees(0, 180, 10),
                                degrees(45, -180, 0),
                                degrees(-33, 179.999999, 500),
                                degrees(60, 24, 1e6),
                                degrees(1e-9, 1e-9, -400),
                                degrees(89.999999, 77, 11000)};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 50; ++i) list.push_back(degrees(89.9 * unit(random), 180 * unit(random), 1e5 * unit(random) + 9e4));
  return list;
}

TEST(Ecef, PublishedPoint) {
  // Example of GeographicLib's CartConvert manual: 33.3 44.4 6000 -> 3816209.60 3737108.55 3485109.57, two decimals.
  const Eigen::Vector3d r = ecef_from_geodetic(degrees(33.3, 44.4, 6000));
  EXPECT_NEAR(r.x(), 3816209.60, 0.005);
  EXPECT_NEAR(r.y(), 3737108.55, 0.005);
  EXPECT_NEAR(r.z(), 3485109.57, 0.005);
}

TEST(Ecef, AxesOfTheEllipsoid) {
  EXPECT_NEAR(ecef_from_geodetic(degrees(0, 0, 0)).x(), kA, 1e-9);
  EXPECT_NEAR(ecef_from_geodetic(degrees(0, 90, 5)).y(), kA + 5, 1e-8);
  EXPECT_NEAR(ecef_from_geodetic(degrees(-90, 0, 0)).z(), -kB, 5e-5);  // printed to 1e-4 m
}

TEST(Ecef, RoundTripEverywhere) {
  for (const Geodetic& p : places()) {
    const Eigen::Vector3d r = ecef_from_geodetic(p);
    const Geodetic back = geodetic_from_ecef(r);
    EXPECT_LT((ecef_from_geodetic(back) - r).norm(), 1e-8) << p.latitude << " " << p.longitude << " " << p.height;
    EXPECT_NEAR(back.height, p.height, 1e-8);
    EXPECT_NEAR(back.latitude, p.latitude, 2e-15);
    EXPECT_GT(back.longitude, -kPi);
    EXPECT_LE(back.longitude, kPi);
  }
}

TEST(Ecef, DateLineIsPlus180) {
  EXPECT_DOUBLE_EQ(geodetic_from_ecef({-kA, -0.0, 0.0}).longitude, kPi);
  EXPECT_DOUBLE_EQ(geodetic_from_ecef({-kA, 0.0, 0.0}).longitude, kPi);
  EXPECT_LT(geodetic_from_ecef({-kA, -1.0, 0.0}).longitude, 0.0);
}

TEST(LocalFrameAxes, AreTheDerivativesOfPosition) {
  const double step = 1e-5;  // rad and m scaled below; the central difference is exact to (step)^2 / 6 = 2e-11
  for (const Geodetic& p : places()) {
    if (std::abs(p.latitude) > 1.57) continue;  // the derivative by longitude vanishes at the pole
    const Eigen::Matrix3d C = C_n_e(p);
    const auto difference = [&](double lat, double lon, double height) -> Eigen::Vector3d {
      return (ecef_from_geodetic({p.latitude + lat, p.longitude + lon, p.height + height}) -
              ecef_from_geodetic({p.latitude - lat, p.longitude - lon, p.height - height}))
          .normalized();
    };
    EXPECT_LT((C.col(0) - difference(step, 0, 0)).norm(), 1e-9);
    EXPECT_LT((C.col(1) - difference(0, step, 0)).norm(), 2e-8);  // rounding 1e-9 m over the short arcs near a pole
    EXPECT_LT((C.col(2) + difference(0, 0, 100)).norm(), 1e-10);
    EXPECT_NEAR(C.determinant(), 1.0, 1e-14);
  }
}

TEST(LocalFrameAxes, PoleTakesItsLongitude) {
  const Eigen::Matrix3d C = C_n_e(degrees(90, 90, 0));
  EXPECT_LT((C.col(0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-15);  // north along longitude 90 deg, over the pole
  EXPECT_LT((C.col(2) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-15);
}

TEST(Radii, AgainstArcsOfTheEllipsoid) {
  for (const double latitude : {-1.2, -0.3, 0.0, 0.7, 1.5}) {
    const double h = 1e-4;  // remainder h^2/6 of the arc: 2e-9
    const Radii radii = radii_of_curvature(latitude);
    const Eigen::Vector3d arc = ecef_from_geodetic({latitude + h, 0, 0}) - ecef_from_geodetic({latitude - h, 0, 0});
    EXPECT_NEAR(radii.meridian, arc.norm() / (2 * h), 0.05);
    EXPECT_NEAR(radii.prime_vertical * std::cos(latitude), ecef_from_geodetic({latitude, 0, 0}).x(), 1e-8);
  }
  EXPECT_NEAR(radii_of_curvature(0).meridian, kA * (1 - kE2), 1e-5);
  EXPECT_NEAR(radii_of_curvature(kPi / 2).meridian, 6399593.6258, 5e-5);  // polar radius of curvature, NGA.STND.0036
}

TEST(Gravity, PublishedAtEquatorAndPole) {
  EXPECT_NEAR(gravity_e({kA, 0, 0}).norm(), kGravityEquator, 1e-10);
  EXPECT_NEAR(gravity_e(ecef_from_geodetic(degrees(90, 0, 0))).norm(), kGravityPole, 1e-10);
}

TEST(Gravity, SomiglianaOnTheEllipsoid) {
  for (const double latitude : {-80.0, -45.0, 10.0, 33.3, 60.0}) {
    const Geodetic p = degrees(latitude, 12, 0);
    const double s2 = std::pow(std::sin(p.latitude), 2);
    const double expected = kGravityEquator * (1 + kSomigliana * s2) / std::sqrt(1 - kE2 * s2);
    const Eigen::Vector3d g_n = C_n_e(p).transpose() * gravity_e(ecef_from_geodetic(p));
    EXPECT_NEAR(g_n.z(), expected, 1e-9);  // the constants' printed digits
    EXPECT_NEAR(g_n.x(), 0.0, 1e-12);      // on the ellipsoid the plumb line is its normal
    EXPECT_NEAR(g_n.y(), 0.0, 1e-12);
  }
}

TEST(Gravity, DecreasesWithHeight) {
  // Heiskanen and Moritz (1967) eq. (2-123), second order in height; m = omega^2 a^2 b / GM.
  const double f = 1 - kB / kA;
  const double m = kEarthRate * kEarthRate * kA * kA * kB / kGM;
  for (const double latitude : {0.0, 40.0, -75.0}) {
    const Geodetic ground = degrees(latitude, 0, 0);
    const double s2 = std::pow(std::sin(ground.latitude), 2);
    const double g0 = gravity_e(ecef_from_geodetic(ground)).norm();
    for (const double height : {-300.0, 1000.0, 5000.0}) {
      const double expected = g0 * (1 - 2 / kA * (1 + f + m - 2 * f * s2) * height + 3 * height * height / (kA * kA));
      // Neglected at 5 km: f^2 h/a terms 2 (f^2 + f m) h/a g = 3e-7, 6 f (h/a)^2 g = 1e-7, 4 (h/a)^3 g = 2e-8.
      EXPECT_NEAR(gravity_e(ecef_from_geodetic(degrees(latitude, 0, height))).norm(), expected, 6e-7);
    }
  }
}

TEST(LocalGravity, FollowsTheFullModel) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  LocalGravity local;
  Eigen::Vector3d r = ecef_from_geodetic(degrees(50, 8, 300));
  for (int i = 0; i < 500; ++i) {
    r += 20.0 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    EXPECT_LT((local.at(r) - gravity_e(r)).norm(), 1e-8);
  }
  // A jump to the other side of the Earth is a new point.
  EXPECT_LT((local.at(-r) - gravity_e(-r)).norm(), 1e-12);
}

TEST(LocalGravity, GradientOfAPointMassWithinTheFlattening) {
  LocalGravity local;
  const Eigen::Vector3d r = ecef_from_geodetic(degrees(35, -60, 1000));
  (void)local.at(r);
  const Eigen::Vector3d u = r.normalized();
  const Eigen::Matrix3d point_mass = kGM / std::pow(r.norm(), 3) * (3 * u * u.transpose() - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d centrifugal = kEarthRate * kEarthRate * Eigen::Vector3d(1, 1, 0).asDiagonal().toDenseMatrix();
  // J2 changes the gradient by a few J2 = 1e-3 of itself.
  test::expect_near_matrix(local.gradient(), point_mass + centrifugal, 6e-3, "gravity gradient");
  test::expect_near_matrix(local.gradient(), local.gradient().transpose(), 1e-9, "a potential's gradient is symmetric");
  EXPECT_NEAR(local.gradient().trace(), 2 * kEarthRate * kEarthRate, 1e-15);  // Laplace, with the centrifugal part
}

TEST(LocalFrame, OriginAndAxes) {
  const Geodetic origin = degrees(46.5, 6.6, 400);
  const LocalFrame frame(origin);
  EXPECT_LT(frame.to_ned(ecef_from_geodetic(origin)).norm(), 1e-12);
  EXPECT_NEAR(frame.to_ned(ecef_from_geodetic(degrees(46.5, 6.6, 450))).z(), -50.0, 1e-8);
  const Eigen::Vector3d ned(120, -40, 7);
  EXPECT_LT((frame.to_ned(frame.to_ecef(ned)) - ned).norm(), 1e-8);
  // 1e-5 deg north is M dlat; the neglected curvature is s^2 / 2M = 1e-7 m.
  const Geodetic north = degrees(46.50001, 6.6, 400);
  EXPECT_NEAR(frame.to_ned(ecef_from_geodetic(north)).x(),
              1e-5 * kDegree * (radii_of_curvature(origin.latitude).meridian + 400), 1e-6);
}

TEST(Utm, PublishedPoint) {
  // Example of GeographicLib's GeoConvert manual: 38n 444140.54 3684706.36 is 33.3 44.4; a centimetre is 1e-7 deg.
  const Geodetic p = geodetic_from_utm(38, true, 444140.54, 3684706.36, 12.0);
  EXPECT_NEAR(p.latitude / kDegree, 33.3, 1e-7);
  EXPECT_NEAR(p.longitude / kDegree, 44.4, 1e-7);
  EXPECT_EQ(p.height, 12.0);
}

TEST(Utm, CentralMeridianIsTheScaledArc) {
  const double latitude = 0.8;
  const int n = 2000;  // Simpson's rule over the meridian radius: remainder far below 1e-6 m
  double arc = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double weight = i == 0 || i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    arc += weight * radii_of_curvature(latitude * i / n).meridian * latitude / n / 3.0;
  }
  const Geodetic north = geodetic_from_utm(31, true, 500000.0, 0.9996 * arc, 0.0);
  EXPECT_NEAR(north.latitude, latitude, 1e-12);
  EXPECT_NEAR(north.longitude, 3.0 * kDegree, 1e-14);
  EXPECT_NEAR(geodetic_from_utm(31, false, 500000.0, 1e7 - 0.9996 * arc, 0.0).latitude, -latitude, 1e-12);
}

TEST(Utm, RefusesOtherZones) {
  EXPECT_THROW((void)geodetic_from_utm(0, true, 500000, 4e6, 0), std::invalid_argument);
  EXPECT_THROW((void)geodetic_from_utm(61, true, 500000, 4e6, 0), std::invalid_argument);
  EXPECT_THROW((void)geodetic_from_utm(31, true, 9e7, 4e6, 0), std::invalid_argument);
}

}  // namespace
}  // namespace coast::geo
