// Each file is read back by a parser of this test alone.

#include "coast/io/event_writers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using test::Files;

constexpr double kRadians = 3.14159265358979323846 / 180.0;

/// A camera near Lausanne that looks down and a little ahead.
record::MarkedState exposure(const std::string& id) {
  record::MarkedState state;
  state.mark.id = id;
  state.nav.t = geo::GpsTime::from_week(2374, 243276.123456789);
  const geo::Geodetic p{46.52 * kRadians, 6.57 * kRadians, 512.345};
  state.nav.r_eb_e = geo::ecef_from_geodetic(p);
  const Eigen::Matrix3d C_n_e = geo::C_n_e(p);
  state.nav.v_eb_e = C_n_e * Eigen::Vector3d(10.0, -5.0, 0.25);
  state.nav.q_b_e = Eigen::Quaterniond(C_n_e * geo::dcm_from_euler({2.0 * kRadians, 15.0 * kRadians, -120.0 * kRadians}));
  state.cov.position = Eigen::Vector3d(1e-4, 4e-4, 9e-4).asDiagonal();
  state.cov.position(0, 1) = state.cov.position(1, 0) = 1e-4;
  state.cov.velocity = 1e-6 * Eigen::Matrix3d::Identity();
  state.cov.attitude = 1e-6 * Eigen::Matrix3d::Identity();
  return state;
}

/// Column by name, of a row; no quotes.
struct Table {
  explicit Table(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
      std::vector<std::string>& row = rows.emplace_back();
      std::istringstream fields(line);
      std::string field;
      while (std::getline(fields, field, ',')) row.push_back(field);
    }
  }
  [[nodiscard]] double at(std::size_t row, const std::string& column) const {
    for (std::size_t i = 0; i < rows[0].size(); ++i)
      if (rows[0][i] == column) return std::stod(rows[row + 1].at(i));
    ADD_FAILURE() << "no column " << column;
    return NAN;
  }
  std::vector<std::vector<std::string>> rows;
};

TEST(EventFiles, CsvHasEverythingOfAnEvent) {
  const Files files;
  const record::MarkedState state = exposure("DJI_0012.JPG");
  write_events_csv(files.path("events.csv"), {state, exposure("b")});
  const Table table(files.get("events.csv"));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[1][0], "DJI_0012.JPG");
  EXPECT_EQ(table.rows[2][0], "b");
  EXPECT_EQ(table.at(0, "gps_week"), 2374.0);
  EXPECT_NEAR(table.at(0, "sow_s"), 243276.123456789, 1e-9);
  EXPECT_NEAR(table.at(0, "lat_deg"), 46.52, 1e-11);
  EXPECT_NEAR(table.at(0, "lon_deg"), 6.57, 1e-11);
  EXPECT_NEAR(table.at(0, "height_m"), 512.345, 1e-5);
  EXPECT_NEAR(table.at(0, "x_m"), state.nav.r_eb_e.x(), 6e-6);
  EXPECT_NEAR(table.at(0, "y_m"), state.nav.r_eb_e.y(), 6e-6);
  EXPECT_NEAR(table.at(0, "z_m"), state.nav.r_eb_e.z(), 6e-6);
  EXPECT_NEAR(table.at(0, "ve_mps"), -5.0, 1e-6);
  EXPECT_NEAR(table.at(0, "roll_deg"), 2.0, 1e-8);
  EXPECT_NEAR(table.at(0, "pitch_deg"), 15.0, 1e-8);
  EXPECT_NEAR(table.at(0, "yaw_deg"), -120.0, 1e-8);
  EXPECT_NEAR(table.at(0, "sde_m"), 0.02, 1e-6);
  EXPECT_NEAR(table.at(0, "corr_ne"), 0.5, 1e-6);
  EXPECT_NEAR(table.at(0, "sdvd_mps"), 1e-3, 1e-7);
  EXPECT_NEAR(table.at(0, "sd_pitch_deg"), 1e-3 / kRadians, 1e-7);  // psi_n is isotropic: pitch has its sd
}

TEST(EventFiles, NamesWithCommasAreQuoted) {
  const Files files;
  write_events_csv(files.path("events.csv"), {exposure("a, \"b\"")});
  EXPECT_NE(files.get("events.csv").find("\n\"a, \"\"b\"\"\",2374,"), std::string::npos) << files.get("events.csv");
}

/// Where a point of the image looks to in the world, by the collinearity equations with the matrix of the textbooks: elements
/// written out, not as a product of rotations.
Eigen::Vector3d ray_enu(double omega, double phi, double kappa, const Eigen::Vector3d& image) {
  const double so = std::sin(omega), co = std::cos(omega), sp = std::sin(phi), cp = std::cos(phi), sk = std::sin(kappa),
               ck = std::cos(kappa);
  Eigen::Matrix3d R;
  R << cp * ck, -cp * sk, sp,                                    //
      co * sk + so * sp * ck, co * ck - so * sp * sk, -so * cp,  //
      so * sk - co * sp * ck, so * ck + co * sp * sk, co * cp;
  return R * image;
}

TEST(EventFiles, OmegaPhiKappaLooksWhereTheCameraLooks) {
  const Files files;
  write_events_opk(files.path("opk.csv"), {exposure("a")});
  const Table table(files.get("opk.csv"));
  const auto ray = [&](const Eigen::Vector3d& image) {
    return ray_enu(table.at(0, "omega_deg") * kRadians, table.at(0, "phi_deg") * kRadians, table.at(0, "kappa_deg") * kRadians,
                   image);
  };
  // By compass and plumb line: heading -120 deg, nose 15 deg up, right side 2 deg down.
  const double yaw = -120.0 * kRadians, pitch = 15.0 * kRadians, roll = 2.0 * kRadians;
  const Eigen::Vector3d ahead(std::sin(yaw), std::cos(yaw), 0.0), up(0.0, 0.0, 1.0);
  const Eigen::Vector3d level_right(std::cos(yaw), -std::sin(yaw), 0.0);
  const Eigen::Vector3d top = std::cos(pitch) * ahead + std::sin(pitch) * up;
  const Eigen::Vector3d level_up = std::cos(pitch) * up - std::sin(pitch) * ahead;
  const Eigen::Vector3d right = std::cos(roll) * level_right - std::sin(roll) * level_up;
  EXPECT_LT((ray(Eigen::Vector3d::UnitY()) - top).norm(), 1e-10);
  EXPECT_LT((ray(Eigen::Vector3d::UnitX()) - right).norm(), 1e-10);
  EXPECT_LT((ray(-Eigen::Vector3d::UnitZ()) - top.cross(right)).norm(), 1e-10);  // the view
  EXPECT_LT(ray(-Eigen::Vector3d::UnitZ()).z(), -0.9);
  EXPECT_NEAR(table.at(0, "sd_phi_deg"), 1e-3 / kRadians, 1e-7);  // psi is isotropic: phi has its sd
  EXPECT_NEAR(table.at(0, "sdd_m"), 0.03, 1e-6);
}

TEST(EventFiles, GeoTxtOfOpenDroneMap) {
  const Files files;
  write_odm_geo(files.path("geo.txt"), {exposure("DJI_0012.JPG"), exposure("with a blank"), exposure("b.jpg")});
  std::istringstream lines(files.get("geo.txt"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "EPSG:4326");
  std::string image;
  double longitude, latitude, height, yaw, pitch, roll, horizontal, vertical;
  ASSERT_TRUE(lines >> image >> longitude >> latitude >> height >> yaw >> pitch >> roll >> horizontal >> vertical);
  EXPECT_EQ(image, "DJI_0012.JPG");
  EXPECT_NEAR(longitude, 6.57, 1e-11);
  EXPECT_NEAR(latitude, 46.52, 1e-11);
  EXPECT_NEAR(height, 512.345, 1e-5);
  EXPECT_NEAR(yaw, -120.0, 1e-6);
  EXPECT_NEAR(pitch, 15.0, 1e-6);
  EXPECT_NEAR(roll, 2.0, 1e-6);
  EXPECT_NEAR(horizontal, 0.02, 1e-5);
  EXPECT_NEAR(vertical, 0.03, 1e-5);
  std::getline(lines, line);
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 6), "b.jpg ");
  EXPECT_FALSE(std::getline(lines, line));
}

std::shared_ptr<const Projection> lv95() {
  ProjectionOptions options;
  options.crs = "EPSG:2056";
  return std::make_shared<Projection>(options);
}

// Rays of the image on the grid: the positions of two points along a ray differ on the grid by that ray turned by the angles.
TEST(EventFiles, OmegaPhiKappaOfAProjectionTurnWithTheGrid) {
  const Files files;
  const auto projection = lv95();
  const record::MarkedState state = exposure("a");
  write_events_opk(files.path("opk.csv"), {state}, projection.get());
  const Table table(files.get("opk.csv"));
  const GridPosition p = projection->at(state.nav.r_eb_e, state.nav.t);
  EXPECT_NEAR(table.at(0, "easting_m"), p.easting, 1e-5);
  EXPECT_NEAR(table.at(0, "northing_m"), p.northing, 1e-5);
  EXPECT_NEAR(table.at(0, "height_m"), p.height, 1e-5);
  // The top of the image as an azimuth on the grid, from the images of two points 20 m apart.
  const Eigen::Vector3d top_e = state.nav.q_b_e * Eigen::Vector3d::UnitX();
  const GridPosition q = projection->at(state.nav.r_eb_e + 20.0 * top_e, state.nav.t);
  const Eigen::Vector3d top = ray_enu(table.at(0, "omega_deg") * kRadians, table.at(0, "phi_deg") * kRadians,
                                      table.at(0, "kappa_deg") * kRadians, Eigen::Vector3d::UnitY());
  // The plumb lines of both ellipsoids differ by 3e-5 rad, and the ray climbs by a quarter of its length.
  EXPECT_NEAR(std::atan2(top.x(), top.y()), std::atan2(q.easting - p.easting, q.northing - p.northing), 1e-5);
  const double convergence = projection->convergence(state.nav.r_eb_e, state.nav.t);
  EXPECT_GT(std::abs(convergence), 0.01);  // 0.6 deg: seen above
  // sigma^2 along grid north: c^2 v_nn + 2 c s v_ne + s^2 v_ee
  const double c = std::cos(convergence), s = std::sin(convergence);
  EXPECT_NEAR(table.at(0, "sd_northing_m"), std::sqrt(c * c * 1e-4 + 2.0 * c * s * 1e-4 + s * s * 4e-4), 1e-6);
}

TEST(EventFiles, GridTableHasBothHeadings) {
  const Files files;
  const auto projection = lv95();
  write_events_grid(files.path("grid.csv"), {exposure("a"), exposure("b")}, *projection);
  const Table table(files.get("grid.csv"));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_NEAR(table.at(1, "heading_true_deg"), 240.0, 1e-8);
  EXPECT_NEAR(table.at(1, "heading_grid_deg"), 240.0 - table.at(1, "convergence_deg"), 1e-8);
  write_events_grid(files.path("none.csv"), {}, *projection);
  EXPECT_EQ(Table(files.get("none.csv")).rows.size(), 1U);
}

TEST(EventFiles, TagsOfExif) {
  const Files files;
  record::MarkedState west = exposure("west.jpg");
  const geo::Geodetic p{-33.5 * kRadians, -70.25 * kRadians, -12.5};
  west.nav.r_eb_e = geo::ecef_from_geodetic(p);
  // Looks ahead to the east: the nose of its axes is up.
  west.nav.q_b_e = Eigen::Quaterniond(geo::C_n_e(p) * geo::dcm_from_euler({0.0, 90.0 * kRadians, 90.0 * kRadians}));
  write_events_exif(files.path("exif.csv"), {exposure("DJI_0012.JPG"), exposure("13"), west}, nullptr, 0.0);
  const Table table(files.get("exif.csv"));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0][0], "SourceFile");
  EXPECT_EQ(table.rows[1][0], "DJI_0012.JPG");
  EXPECT_NEAR(table.at(0, "GPSLatitude"), 46.52, 1e-9);
  EXPECT_EQ(table.rows[1][2], "N");
  EXPECT_NEAR(table.at(0, "GPSImgDirection"), 240.0, 2.0);  // rolled by 2 deg
  EXPECT_NEAR(table.at(1, "GPSLatitude"), 33.5, 1e-9);
  EXPECT_EQ(table.rows[2][2], "S");
  EXPECT_EQ(table.rows[2][4], "W");
  EXPECT_NEAR(table.at(1, "GPSAltitude"), 12.5, 1e-3);
  EXPECT_EQ(table.at(1, "GPSAltitudeRef"), 1.0);
  EXPECT_NEAR(table.at(1, "GPSImgDirection"), 90.0, 1e-3);
}

/// A JPEG of one grey pixel.
std::string pixel() {
  const auto bytes = std::to_array<unsigned char>(
      {0xff, 0xd8, 0xff, 0xdb, 0x00, 0x43, 0x00, 3,    2,    2,    2,    2,    2,    3,    2,    2,    2,    3,
       3,    3,    3,    4,    6,    4,    4,    4,    4,    4,    8,    6,    6,    5,    6,    9,    8,    10,
       10,   9,    8,    9,    9,    10,   12,   15,   12,   10,   11,   14,   11,   9,    9,    13,   17,   13,
       14,   15,   16,   16,   17,   16,   10,   12,   18,   19,   18,   16,   19,   15,   16,   16,   16,   0xff,
       0xc9, 0x00, 0x0b, 0x08, 0x00, 0x01, 0x00, 0x01, 0x01, 0x01, 0x11, 0,    0xff, 0xcc, 0x00, 0x06, 0x00, 0x10,
       0x10, 0x05, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0xd2, 0xcf, 0x20, 0xff, 0xd9});
  return {bytes.begin(), bytes.end()};
}

TEST(EventFiles, ExiftoolWritesTheTagsIntoImages) {
  if (!std::filesystem::exists("/usr/bin/exiftool")) GTEST_SKIP() << "no exiftool (libimage-exiftool-perl)";
  const Files files;
  files.put("DJI_0012.JPG", pixel());
  write_events_exif(files.path("exif.csv"), {exposure("DJI_0012.JPG")}, nullptr, 48.0);
  const auto run = [&](const std::string& command) {
    const std::string whole = "cd '" + files.path("").string() + "' && " + command + " 2>&1";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(whole.c_str(), "r"), &pclose);
    std::string text;
    std::array<char, 512> block{};
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe.get())) text.append(block.data(), n);
    return text;
  };
  const std::string written = run("exiftool -overwrite_original -csv=exif.csv DJI_0012.JPG");
  EXPECT_NE(written.find("1 image files updated"), std::string::npos) << written;
  const std::string told = run(
      "exiftool -n -s3 -p '$EXIF:GPSLatitude $EXIF:GPSLatitudeRef $EXIF:GPSLongitude $EXIF:GPSLongitudeRef $EXIF:GPSAltitude "
      "$EXIF:GPSAltitudeRef $EXIF:GPSImgDirectionRef $EXIF:GPSDateStamp $EXIF:GPSTimeStamp' DJI_0012.JPG");
  double latitude = 0.0, longitude = 0.0, altitude = 0.0, second = 0.0;
  int below = -1, year = 0, month = 0, day = 0, hour = 0, minute = 0;
  ASSERT_EQ(std::sscanf(told.c_str(), "%lf N %lf E %lf %d T %d:%d:%d %d:%d:%lf", &latitude, &longitude, &altitude, &below,
                        &year, &month, &day, &hour, &minute, &second),
            10)
      << told;
  EXPECT_NEAR(latitude, 46.52, 1e-8);
  EXPECT_NEAR(longitude, 6.57, 1e-8);
  EXPECT_NEAR(altitude, 464.345, 1e-3);
  EXPECT_EQ(below, 0);
  EXPECT_EQ(year * 10000 + month * 100 + day, 20250708);
  EXPECT_NEAR(hour * 3600.0 + minute * 60.0 + second, 243276.123 - 2 * 86400.0 - 18.0, 1e-2);
}

}  // namespace
}  // namespace coast::io
