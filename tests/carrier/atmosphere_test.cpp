#include "coast/carrier/atmosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "coast/geo/units.hpp"

namespace coast::carrier {
namespace {

constexpr double kLight = 299792458.0;

TEST(Direction, OfPointsAboutAReceiver) {
  const geo::Geodetic at{46.5 * geo::kDegree, 6.5 * geo::kDegree, 400.0};
  const geo::LocalFrame local(at);
  const Eigen::Vector3d receiver = geo::ecef_from_geodetic(at);
  const Direction west = direction_of(local.to_ecef({0.0, -1000.0, -1000.0}), receiver);
  EXPECT_NEAR(west.azimuth, 270.0 * geo::kDegree, 1e-9);
  EXPECT_NEAR(west.elevation, 45.0 * geo::kDegree, 1e-9);
  EXPECT_NEAR(direction_of(local.to_ecef({0.0, 0.0, -1e6}), receiver).elevation, 90.0 * geo::kDegree, 1e-9);
}

// With the first coefficients alone the model is a constant by night and a cosine by day, to its fourth order, about 14 h of
// local time at the point where the signal passes the ionosphere; from the zenith that is above the receiver within 0.5
// degrees.
TEST(Klobuchar, IsItsOwnCosine) {
  record::Klobuchar model;
  model.alpha[0] = 2e-8;
  model.beta[0] = 100000.0;
  const geo::Geodetic greenwich{0.9, 0.0, 0.0};
  const Direction zenith{0.0, 90.0 * geo::kDegree};
  const double obliquity = 1.0 + 16.0 * 0.03 * 0.03 * 0.03;
  const auto delay = [&](double local) {
    return klobuchar_delay(model, greenwich, zenith, geo::GpsTime::from_week(2200, local));
  };
  EXPECT_NEAR(delay(2.0 * 3600.0), kLight * 5e-9 * obliquity, 1e-9);
  EXPECT_NEAR(delay(50400.0), kLight * 2.5e-8 * obliquity, 1e-9);
  const double x = 2.0 * std::numbers::pi * 10000.0 / 100000.0;
  EXPECT_NEAR(delay(60400.0), kLight * (5e-9 + 2e-8 * (1.0 - x * x / 2.0 + x * x * x * x / 24.0)) * obliquity, 1e-9);
  EXPECT_NEAR(delay(60400.0), kLight * (5e-9 + 2e-8 * std::cos(x)) * obliquity, 2e-3 * kLight * 2e-8);
  // 15 degrees east it is an hour later.
  const geo::Geodetic east{0.9, 15.0 * geo::kDegree, 0.0};
  EXPECT_NEAR(klobuchar_delay(model, east, zenith, geo::GpsTime::from_week(2200, 56800.0)), delay(60400.0), 1e-9);
}

// Against the test case of the IERS Conventions' GMF (2010, chapter 9, GMF.F: 3.425246 and 3.449589), another mapping: both are
// good to 0.2 % at 16.7 degrees.
TEST(Troposphere, NiellMapping) {
  const geo::Geodetic at{0.6708665767, -1.393397187, 844.715};
  const geo::GpsTime t = geo::GpsTime::from_calendar({2009, 8, 12, 0, 0, 0.0});  // MJD 55055
  const double elevation = std::numbers::pi / 2.0 - 1.278564131;
  const TroposphericMapping mapping = niell_mapping(at, elevation, t);
  EXPECT_NEAR(mapping.hydrostatic / 3.425246, 1.0, 0.002);
  EXPECT_NEAR(mapping.wet / 3.449589, 1.0, 0.002);
  const TroposphericMapping zenith = niell_mapping(at, std::numbers::pi / 2.0, t);
  EXPECT_NEAR(zenith.hydrostatic, 1.0, 1e-12);
  EXPECT_NEAR(zenith.wet, 1.0, 1e-12);
  // The seasons of the south are half a year away.
  const geo::Geodetic north{45.0 * geo::kDegree, 0.0, 0.0}, south{-45.0 * geo::kDegree, 0.0, 0.0};
  const geo::GpsTime february = geo::GpsTime::from_calendar({2009, 2, 10, 0, 0, 0.0});
  EXPECT_NEAR(niell_mapping(north, 0.1, february).hydrostatic,
              niell_mapping(south, 0.1, february + 182.625 * 86400.0).hydrostatic, 1e-9);
  EXPECT_THROW(static_cast<void>(niell_mapping(at, 0.0, t)), std::invalid_argument);
}

}  // namespace
}  // namespace coast::carrier
