// Projections against closed forms of GeographicLib, published points, and cs2cs in a process of its own.

#include "coast/io/projection.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <GeographicLib/PolarStereographic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "coast/record/error.hpp"

namespace coast::io {
namespace {

const geo::GpsTime kTime = geo::GpsTime::from_week(2374, 243258.5);

Eigen::Vector3d place(double latitude_deg, double longitude_deg, double height = 0.0) {
  return geo::ecef_from_geodetic({latitude_deg * geo::kDegree, longitude_deg * geo::kDegree, height});
}

ProjectionOptions options(const std::string& crs, const std::string& from = ProjectionOptions::kWgs84) {
  ProjectionOptions stated;
  stated.crs = crs;
  stated.from = from;
  return stated;
}

std::string projection_refusal(const ProjectionOptions& stated) {
  try {
    const Projection projection(stated);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool says(const record::Events& events, const char* kind) {
  return std::ranges::any_of(events, [&](const record::Event& event) { return event.kind == kind; });
}

TEST(Projection, UtmIsThatOfGeographicLib) {
  for (const auto& [latitude, longitude, code] : {std::tuple{48.1, 11.5, 32632},
                                                  {59.9, 6.2, 32632},
                                                  {-33.9, 18.5, 32734},
                                                  {0.001, -177.1, 32601},
                                                  {-89.0 + 10.0, 8.0, 32732},
                                                  {83.9, 11.9, 32632}}) {
    const Projection projection(options(fmt::format("EPSG:{}", code)));
    const Eigen::Vector3d r_e = place(latitude, longitude, 812.5);
    const GridPosition p = projection.at(r_e, kTime);
    int zone = 0;
    bool north = false;
    double x = 0.0, y = 0.0, gamma = 0.0, k = 0.0;
    GeographicLib::UTMUPS::Forward(latitude, longitude, zone, north, x, y, gamma, k, code % 100);
    EXPECT_NEAR(p.easting, x, 1e-6) << code;
    EXPECT_NEAR(p.northing, y, 1e-6) << code;
    EXPECT_NEAR(p.height, 812.5, 1e-6) << code;
    EXPECT_NEAR(projection.convergence(r_e, kTime) / geo::kDegree, gamma, 1e-8) << code;
    const GridScale scale = projection.scale(r_e, kTime);
    EXPECT_NEAR(scale.point, k, 1e-9) << code;
    const geo::Radii radii = geo::radii_of_curvature(latitude * geo::kDegree);
    const double lifted =
        std::sqrt(radii.meridian / (radii.meridian + 812.5) * radii.prime_vertical / (radii.prime_vertical + 812.5));
    EXPECT_NEAR(scale.combined, k * lifted, 1e-9) << code;
    EXPECT_EQ(projection.columns().easting, "easting_m");
    EXPECT_EQ(projection.columns().height, "height_m");
  }
}

TEST(Projection, PolarAndGaussKruegerOfAProjString) {
  const GeographicLib::PolarStereographic& ups = GeographicLib::PolarStereographic::UPS();
  const Projection polar(options("+proj=stere +lat_0=90 +lon_0=0 +k=0.994 +x_0=0 +y_0=0 +datum=WGS84"));
  double x = 0.0, y = 0.0, gamma = 0.0, k = 0.0;
  ups.Forward(true, 86.5, -130.0, x, y, gamma, k);
  const GridPosition p = polar.at(place(86.5, -130.0), kTime);
  EXPECT_NEAR(p.easting, x, 1e-6);
  EXPECT_NEAR(p.northing, y, 1e-6);
  EXPECT_NEAR(std::remainder(polar.convergence(place(86.5, -130.0), kTime) / geo::kDegree - gamma, 360.0), 0.0, 1e-8);

  // A site of one's own on GRS 80, without a datum: taken for that of GNSS.
  const Projection local(options("+proj=tmerc +lat_0=0 +lon_0=9.25 +k=1.00005 +x_0=50000 +y_0=-5000000 +ellps=GRS80 +units=m"));
  const GeographicLib::TransverseMercator tm(6378137.0, 1.0 / 298.257222101, 1.00005);
  tm.Forward(9.25, 47.5, 9.4, x, y, gamma, k);
  const GridPosition q = local.at(place(47.5, 9.4, 400.0), kTime);
  EXPECT_NEAR(q.easting, x + 50000.0, 1e-6);
  EXPECT_NEAR(q.northing, y - 5e6, 1e-6);
  EXPECT_NEAR(q.height, 400.0, 2e-4);  // WGS 84 and GRS 80 differ by 0.1 mm
}

// EPSG:31468 has northing first.
TEST(Projection, EastingIsFirstWhateverTheOrderOfTheCode) {
  const Projection projection(options("EPSG:31468", "EPSG:4314"));
  const GeographicLib::TransverseMercator bessel(6377397.155, 1.0 / 299.1528128, 1.0);
  double x = 0.0, y = 0.0, gamma = 0.0, k = 0.0;
  const geo::Geodetic p = geo::geodetic_from_ecef(place(48.0, 11.7));
  bessel.Forward(12.0, p.latitude / geo::kDegree, p.longitude / geo::kDegree, x, y, gamma, k);
  const GridPosition grid = projection.at(place(48.0, 11.7), kTime);
  EXPECT_NEAR(grid.easting, 4500000.0 + x, 1e-6);
  EXPECT_NEAR(grid.northing, y, 1e-6);
}

// Ordnance Survey, A guide to coordinate systems in Great Britain, worked example of annex C: OSGB36 latitude and longitude.
TEST(Projection, PublishedPointOfTheBritishGrid) {
  const Projection projection(options("EPSG:27700", "EPSG:4277"));
  const double latitude = 52.0 + 39.0 / 60.0 + 27.2531 / 3600.0, longitude = 1.0 + 43.0 / 60.0 + 4.5177 / 3600.0;
  const GridPosition p = projection.at(place(latitude, longitude), kTime);
  EXPECT_NEAR(p.easting, 651409.903, 2e-3);  // 0.0001" of latitude is 3 mm
  EXPECT_NEAR(p.northing, 313177.270, 2e-3);
}

// Swisstopo, Formulas and constants for the calculation of the Swiss conformal cylindrical projection: the fundamental point of
// Bern on the ellipsoid of Bessel; and the example of the approximate formulas, which hold to 1 m, for WGS 84.
TEST(Projection, PublishedPointsOfTheSwissGrid) {
  const Projection bessel(options("EPSG:2056", "EPSG:4150"));
  const GridPosition bern = bessel.at(place(46.0 + 57.0 / 60.0 + 8.66 / 3600.0, 7.0 + 26.0 / 60.0 + 22.5 / 3600.0), kTime);
  EXPECT_NEAR(bern.easting, 2600000.0, 1e-3);
  EXPECT_NEAR(bern.northing, 1200000.0, 1e-3);

  Projection gnss(options("EPSG:2056"));
  const Eigen::Vector3d r_e = place(46.0 + 2.0 / 60.0 + 38.87 / 3600.0, 8.0 + 43.0 / 60.0 + 49.79 / 3600.0, 650.60);
  gnss.choose(r_e);
  const GridPosition p = gnss.at(r_e, kTime);
  EXPECT_NEAR(p.easting, 2699999.76, 1.0);
  EXPECT_NEAR(p.northing, 1099999.97, 1.0);
  EXPECT_NEAR(p.height, 600.05, 1.0);
  EXPECT_FALSE(says(gnss.events(), "equal_datums"));
  EXPECT_NE(gnss.heights().find("Bessel"), std::string::npos);
}

// The heading of a line on the ground is that of its image on the grid after the convergence is subtracted.
TEST(Projection, GridHeadingIsTrueHeadingLessConvergence) {
  for (const char* crs : {"EPSG:25832", "EPSG:2056", "EPSG:5513", "EPSG:2053", "EPSG:3413"}) {
    SCOPED_TRACE(crs);
    const bool south = std::string(crs) == "EPSG:2053";
    const double latitude = south ? -26.0 : std::string(crs) == "EPSG:3413" ? 76.0 : 47.1, longitude = south ? 29.9 : 9.3;
    const Eigen::Vector3d r_e = place(latitude, longitude);
    const Projection projection(options(crs));
    const double convergence = projection.convergence(r_e, kTime);
    const double east = projection.columns().easting.starts_with("west") ? -1.0 : 1.0;
    const double north = projection.columns().northing.starts_with("south") ? -1.0 : 1.0;
    const geo::LocalFrame local({latitude * geo::kDegree, longitude * geo::kDegree, 0.0});
    for (const double heading : {0.0, 1.0, 2.5, -2.0}) {
      const Eigen::Vector3d way(20.0 * std::cos(heading), 20.0 * std::sin(heading), 0.0);
      const GridPosition a = projection.at(local.to_ecef(-way), kTime), b = projection.at(local.to_ecef(way), kTime);
      const double grid = std::atan2(east * (b.easting - a.easting), north * (b.northing - a.northing));
      // At a height h lines turn by h (1/M - 1/N): 1e-8 at the 50 m between the ellipsoids.
      EXPECT_NEAR(std::remainder(heading - convergence - grid, 2.0 * geo::kPi), 0.0, 3e-8);
    }
  }
}

TEST(Projection, UnitsAndDirectionsAreInTheNamesOfColumns) {
  const Projection york(options("EPSG:2263", "EPSG:4269"));
  EXPECT_EQ(york.columns().easting, "easting_us_ft");
  EXPECT_EQ(york.columns().height, "height_m");
  EXPECT_NEAR(york.metres(), 1200.0 / 3937.0, 1e-12);
  const Projection south(options("EPSG:2053"));
  EXPECT_EQ(south.columns().easting, "westing_m");
  EXPECT_EQ(south.columns().northing, "southing_m");
  const Eigen::Vector3d r_e = place(-26.0, 28.0);  // a degree west of its meridian
  EXPECT_GT(south.at(r_e, kTime).easting, 9e4);
  EXPECT_GT(south.at(r_e, kTime).northing, 2.8e6);
  const Projection krovak(options("EPSG:5513")), east_north(options("EPSG:5514"));
  const Eigen::Vector3d prague = place(50.08, 14.42);
  EXPECT_NEAR(krovak.at(prague, kTime).easting, -east_north.at(prague, kTime).easting, 1e-6);
  EXPECT_NEAR(krovak.at(prague, kTime).northing, -east_north.at(prague, kTime).northing, 1e-6);
}

TEST(Projection, WhatCannotBeUsedIsRefused) {
  EXPECT_NE(projection_refusal(options("EPSG:99999")).find("crs not found"), std::string::npos)
      << projection_refusal(options("EPSG:99999"));
  EXPECT_NE(projection_refusal(options("foo")).find("no code and no PROJ string"), std::string::npos);
  EXPECT_NE(projection_refusal(options("")).find("no code"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:4326")).find("a geographic CRS (WGS 84)"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:4978")).find("a geocentric CRS"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:5773")).find("a vertical CRS alone"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:4326+5773")).find("a geographic CRS"), std::string::npos);
  EXPECT_NE(projection_refusal(options("+proj=bogus")).find("+proj=bogus"), std::string::npos);
  EXPECT_NE(projection_refusal(options("+proj=tmerc +lon_0=9 +ellps=bessel")).find("without datum"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:25832", "EPSG:5773")).find("is not geographic"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:25832", "EPSG:4978")).find("is not geographic"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:25832", "nowhere")).find("no known code"), std::string::npos);
  EXPECT_NE(projection_refusal(options("EPSG:27572", "EPSG:4807")).find("not in degrees"), std::string::npos);
  ProjectionOptions contradicting = options("EPSG:25832+5773");
  contradicting.orthometric = false;
  EXPECT_NE(projection_refusal(contradicting).find("heights are not ellipsoidal"), std::string::npos);
}

// A national geoid whose grid comes with no package of Debian.
TEST(Projection, AMissingGeoidIsNamed) {
  const std::string told = projection_refusal(options("EPSG:2056+5728"));
  if (told.empty()) GTEST_SKIP() << "the Swiss grids are installed";
  EXPECT_NE(told.find("not installed"), std::string::npos) << told;
  EXPECT_NE(told.find(".tif"), std::string::npos) << told;
  EXPECT_NE(told.find("PROJ_DATA"), std::string::npos) << told;
}

TEST(Projection, OrthometricHeightsAreAboveEgm96) {
  ProjectionOptions stated = options("EPSG:32632");
  stated.orthometric = true;
  const Projection projection(stated), compound(options("EPSG:32632+5773"));
  EXPECT_EQ(projection.crs(), "EPSG:32632+5773");
  EXPECT_TRUE(projection.orthometric());
  EXPECT_EQ(projection.heights(), "EGM96 height");
  const Eigen::Vector3d r_e = place(46.04, 8.73, 650.6);
  EXPECT_DOUBLE_EQ(projection.at(r_e, kTime).height, compound.at(r_e, kTime).height);
  ProjectionOptions own = options("+proj=tmerc +lon_0=9 +ellps=GRS80");
  own.orthometric = true;
  EXPECT_NEAR(Projection(own).at(r_e, kTime).height, projection.at(r_e, kTime).height, 1e-3);
}

/// One number of NOAA's GTX, big-endian.
template <class T>
T big_endian(const std::string& bytes, std::size_t at) {
  std::array<char, sizeof(T)> reversed{};
  for (std::size_t i = 0; i < sizeof(T); ++i) reversed.at(i) = bytes.at(at + sizeof(T) - 1 - i);
  T value{};
  std::memcpy(&value, reversed.data(), sizeof(T));
  return value;
}

/// Undulation, bilinear between the nodes of a grid of the whole Earth.
double undulation(const std::string& gtx, double latitude, double longitude) {
  const double south = big_endian<double>(gtx, 0), west = big_endian<double>(gtx, 8);
  const double d_latitude = big_endian<double>(gtx, 16), d_longitude = big_endian<double>(gtx, 24);
  const auto columns = static_cast<std::size_t>(big_endian<std::int32_t>(gtx, 36));
  const double y = (latitude - south) / d_latitude, x = (longitude - west) / d_longitude;
  const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(x);
  const auto node = [&](std::size_t i, std::size_t j) {
    return static_cast<double>(big_endian<float>(gtx, 40 + 4 * ((row + i) * columns + column + j)));
  };
  const double u = x - static_cast<double>(column), v = y - static_cast<double>(row);
  return (1.0 - v) * ((1.0 - u) * node(0, 0) + u * node(0, 1)) + v * ((1.0 - u) * node(1, 0) + u * node(1, 1));
}

TEST(Projection, OrthometricHeightsAreThoseOfTheGrid) {
  std::ifstream file("/usr/share/proj/egm96_15.gtx", std::ios::binary);
  if (!file) GTEST_SKIP() << "no egm96_15.gtx (proj-data)";
  std::stringstream content;
  content << file.rdbuf();
  const std::string gtx = content.str();
  const Projection projection(options("EPSG:32632+5773"));
  for (const auto& [latitude, longitude] : {std::pair{46.04, 8.73}, {59.913, 10.75}, {0.4, 9.44}}) {
    const double height = projection.at(place(latitude, longitude, 650.6), kTime).height;
    EXPECT_NEAR(height, 650.6 - undulation(gtx, latitude, longitude), 1e-5) << latitude;  // of floats of 50 m
  }
  // NGA's test value for EGM96, F477: 38.6281550 N, 269.7791550 E has -31.628 m; the grid of 15' holds to half a metre there.
  EXPECT_NEAR(undulation(gtx, 38.628155, 269.779155 - 360.0), -31.628, 0.5);
}

// ITRF2014 to ETRF2014 after 30 years: Europe has moved by 0.75 m to the north-east.
TEST(Projection, EpochsMoveFramesOnMovingPlates) {
  ProjectionOptions stated = options("EPSG:25832", "EPSG:7912");
  Projection at_its_time(stated), null(options("EPSG:25832"));
  stated.epoch = 1989.0;
  const Projection in_1989(stated);
  const Eigen::Vector3d r_e = place(48.1, 11.5, 500.0);
  at_its_time.choose(r_e);
  null.choose(r_e);
  const GridPosition now = at_its_time.at(r_e, kTime), then = in_1989.at(r_e, kTime), equal = null.at(r_e, kTime);
  EXPECT_NEAR(std::hypot(now.easting - equal.easting, now.northing - equal.northing), 0.025 * 36.5, 0.1);
  EXPECT_LT(now.easting, equal.easting);
  EXPECT_LT(std::hypot(then.easting - equal.easting, then.northing - equal.northing), 0.06);
  EXPECT_TRUE(says(null.events(), "equal_datums"));
  EXPECT_FALSE(says(at_its_time.events(), "equal_datums"));
}

// ITRF2020 and ITRF2014 differ by millimetres; PROJ knows no direct way from the former to national grids.
TEST(Projection, FramesWithoutADirectWayAreReachedThroughOthers) {
  Projection by_2020(options("EPSG:25832", "EPSG:9989")), by_2014(options("EPSG:25832", "EPSG:7912"));
  const Eigen::Vector3d r_e = place(48.1, 11.5, 500.0);
  by_2020.choose(r_e);
  by_2014.choose(r_e);
  const GridPosition a = by_2020.at(r_e, kTime), b = by_2014.at(r_e, kTime);
  EXPECT_LT(std::hypot(a.easting - b.easting, a.northing - b.northing), 0.01);
  EXPECT_NEAR(a.height, b.height, 0.01);
}

TEST(Projection, PlacesOutsideTheAreaOfUseAreTold) {
  Projection projection(options("EPSG:25832"));
  const Eigen::Vector3d inside = place(48.1, 11.5), outside = place(48.1, 17.5);
  EXPECT_TRUE(projection.covers(inside));
  EXPECT_FALSE(projection.covers(outside));
  projection.choose(inside);
  EXPECT_FALSE(says(projection.events(), "outside_area_of_use"));
  projection.choose(outside);
  EXPECT_TRUE(says(projection.events(), "outside_area_of_use"));
  const Projection pacific(options("EPSG:3832"));  // its area crosses 180 deg
  EXPECT_TRUE(pacific.covers(place(0.0, 179.0)));
  EXPECT_TRUE(pacific.covers(place(0.0, -179.0)));
}

TEST(Projection, APlaceWithoutCoordinatesIsAnError) {
  const Projection projection(options("+proj=gnom +lat_0=90 +lon_0=0 +datum=WGS84"));
  EXPECT_THROW(static_cast<void>(projection.at(place(-45.0, 0.0), kTime)), NumericalError);
}

TEST(Projection, ThreadsGetTheSameCoordinates) {
  const Projection projection(options("EPSG:25832"));
  std::vector<std::vector<double>> of_thread(4);
  std::vector<std::thread> threads;
  for (std::vector<double>& numbers : of_thread)
    threads.emplace_back([&projection, &numbers] {
      for (int i = 0; i < 500; ++i) numbers.push_back(projection.at(place(48.0 + 1e-4 * i, 11.0), kTime).northing);
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<double>& numbers : of_thread) EXPECT_EQ(numbers, of_thread.front());
}

/// What cs2cs makes of latitude, longitude, height; nothing if it is not installed.
std::optional<std::array<double, 3>> by_cs2cs(const std::string& from, const std::string& to, const std::string& line) {
  if (!std::filesystem::exists("/usr/bin/cs2cs")) return std::nullopt;
  const std::string command = fmt::format("echo '{}' | cs2cs -f %.7f {} {} 2>&1", line, from, to);
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::array<double, 3> out{};
  if (!pipe || std::fscanf(pipe.get(), "%lf %lf %lf", &out[0], &out[1], &out[2]) != 3) return std::nullopt;
  return out;
}

TEST(Projection, IsThatOfCs2cs) {
  for (const char* crs : {"EPSG:25832+5773", "EPSG:32632", "EPSG:5514+5773"}) {
    const auto expected = by_cs2cs("EPSG:4979", crs, "49.2 12.3 512.25");
    if (!expected) GTEST_SKIP() << "no cs2cs (proj-bin)";
    Projection projection(options(crs));
    projection.choose(place(49.2, 12.3, 512.25));
    const GridPosition p = projection.at(place(49.2, 12.3, 512.25), kTime);
    EXPECT_NEAR(p.easting, (*expected)[0], 1e-6) << crs;
    EXPECT_NEAR(p.northing, (*expected)[1], 1e-6) << crs;
    EXPECT_NEAR(p.height, (*expected)[2], 1e-6) << crs;
  }
}

TEST(Projection, KeysOfARunFile) {
  const auto read = [](const char* text) { return Projection::from_node(parse_yaml(text, "run.yaml").at("projection")); };
  EXPECT_FALSE(read("projection: {crs: EPSG:25832}")->orthometric());
  EXPECT_TRUE(read("projection: {crs: EPSG:25832+5773}")->orthometric());
  EXPECT_TRUE(read("projection: {crs: EPSG:25832, heights: orthometric, from: EPSG:7912, epoch: 2010.0}")->orthometric());
  for (const char* bad : {"projection: {crs: EPSG:4326}", "projection: {crs: EPSG:25832, epoch: 10}",
                          "projection: {from: EPSG:4979}", "projection: {crs: EPSG:25832, heights: msl}"})
    try {
      static_cast<void>(read(bad));
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("run.yaml:1"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace coast::io
