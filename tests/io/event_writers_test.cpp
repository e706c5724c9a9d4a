// Each file is read back by a parser of this test alone.

#include "coast/io/event_writers.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

}  // namespace
}  // namespace coast::io
